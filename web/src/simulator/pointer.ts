// SPDX-License-Identifier: Apache-2.0
import type { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { Tool } from './tool.ts';

/**
 * Decides whose a press is: the tool's on the body, the view's elsewhere, with the other buttons, or with a second
 * finger. Moves are told to the tool once a frame.
 */
export class Pointer {
  private readonly canvas: HTMLCanvasElement;
  private readonly controls: OrbitControls;
  private readonly tool: () => Tool;
  /** The press that the tool has. */
  private pressed: PointerEvent | undefined;
  private latest: PointerEvent | undefined;
  private handingOn = false;

  constructor(canvas: HTMLCanvasElement, controls: OrbitControls, tool: () => Tool) {
    this.canvas = canvas;
    this.controls = controls;
    this.tool = tool;
    // Before the controls hear it.
    canvas.addEventListener('pointerdown', (event) => this.down(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.up(event));
    canvas.addEventListener('pointercancel', (event) => this.up(event));
    canvas.addEventListener('pointerleave', () => {
      if (!this.pressed) this.forget();
    });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  get isPressed(): boolean {
    return this.pressed !== undefined;
  }

  /** Once a frame; true if the tool was told something. */
  tick(): boolean {
    const event = this.latest;
    this.latest = undefined;
    if (!event) return false;
    const [x, y] = this.placeOf(event);
    if (this.pressed) this.tool().drag(x, y);
    else this.tool().hover(x, y);
    return true;
  }

  private placeOf(event: PointerEvent): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  private down(event: PointerEvent): void {
    if (this.handingOn) return;
    this.canvas.focus({ preventScroll: true });
    if (this.pressed) {
      if (event.pointerType === 'touch') this.handOn();
      return;
    }
    const [x, y] = this.placeOf(event);
    const isTool = event.button === 0 && !event.ctrlKey && !event.metaKey && this.tool().wants(x, y);
    this.controls.enabled = !isTool;
    if (!isTool) return;
    this.pressed = event;
    this.latest = undefined;
    this.canvas.setPointerCapture(event.pointerId);
    this.tool().press(x, y);
  }

  private move(event: PointerEvent): void {
    if (this.pressed && event.pointerId !== this.pressed.pointerId) return;
    if (!this.pressed && event.buttons !== 0) return;
    this.latest = event;
  }

  private up(event: PointerEvent): void {
    if (!this.pressed || event.pointerId !== this.pressed.pointerId) return;
    const [x, y] = this.placeOf(event);
    if (this.latest) this.tool().drag(x, y);
    this.pressed = undefined;
    this.latest = undefined;
    this.tool().release(x, y);
    this.controls.enabled = true;
  }

  /** A second finger: both turn and pinch the view. */
  private handOn(): void {
    const first = this.pressed!;
    const [x, y] = this.placeOf(this.latest ?? first);
    this.pressed = undefined;
    this.latest = undefined;
    this.tool().release(x, y);
    this.controls.enabled = true;
    this.handingOn = true;
    this.canvas.dispatchEvent(new PointerEvent('pointerdown', first));
    this.handingOn = false;
  }

  private forget(): void {
    this.latest = undefined;
    this.tool().rest();
  }
}
