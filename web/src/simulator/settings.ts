// SPDX-License-Identifier: Apache-2.0
import { addCheck, addSlider, byId, make, throttled, type Slider } from './elements.ts';
import type { Connection } from './connection.ts';
import type { SceneFacts, Status } from './protocol.ts';
import type { ToolSettings } from './tool.ts';

const millimetres = (metres: number) => `${(1000 * metres).toFixed(0)} mm`;
const degrees = (radians: number) => `${((180 * radians) / Math.PI).toFixed(0)}°`;

/** What the tool in hand can be told; others are not shown. */
export class ToolOptions {
  private readonly groups = new Map<string, HTMLElement>();
  private readonly pin: HTMLInputElement;

  constructor(settings: ToolSettings) {
    const cut = this.group('scalpel');
    addSlider(cut, { label: 'Depth', lo: 0.002, hi: 0.08, value: settings.depth, show: millimetres, change: (value) => (settings.depth = value) });
    addSlider(cut, { label: 'Lean', lo: -1, hi: 1, value: settings.lean, show: degrees, change: (value) => (settings.lean = value) });
    addCheck(cut, 'Blade along the view', settings.alongView, (on) => (settings.alongView = on));
    const hold = this.group('grasp');
    addSlider(hold, { label: 'Grip', lo: 0.004, hi: 0.025, value: settings.radius, show: millimetres, change: (value) => (settings.radius = value) });
    this.pin = addCheck(hold, 'Pin where it is let go (P)', settings.pin, (on) => (settings.pin = on));
    this.group('line').append(make('p', 'Press, drag, let go: a blade along the view goes from the first point to the second, right through.', 'small'));
    this.group('probe').append(make('p', 'Point at the tissue.', 'small'));
    this.group('turn').append(make('p', 'Drag turns the view.', 'small'));
  }

  show(tool: string): void {
    for (const [name, group] of this.groups) group.hidden = name !== tool;
  }

  showPin(on: boolean): void {
    this.pin.checked = on;
  }

  private group(name: string): HTMLElement {
    const group = make('div');
    this.groups.set(name, group);
    byId('tool-options').append(group);
    return group;
  }
}

const earth = 9.81;
/** Commands of a slider in a second: each changes the step, or nearly all. */
const pause = 250;

/** Sliders that act on the tissue at once. */
export class TissueOptions {
  private young: Slider;
  private poisson: Slider;
  private gravity: Slider;
  private speed: Slider;
  private readonly material = { young: 5000, poisson: 0.35, density: 1000 };
  private down = [0, 0, -earth];

  constructor(connection: () => Connection) {
    const parent = byId('tissue-options');
    const tell = throttled(pause, () => connection().send({ command: { set_material: { region: 0, ...this.material } } }));
    this.young = addSlider(parent, {
      label: 'Young’s modulus', lo: 500, hi: 100_000, value: 5000, logarithmic: true,
      show: (value) => `${(value / 1000).toPrecision(3)} kPa`,
      change: (value) => tell((this.material.young = value)),
    });
    this.poisson = addSlider(parent, {
      label: 'Poisson’s ratio', lo: 0, hi: 0.47, value: 0.35, show: (value) => value.toFixed(2),
      change: (value) => tell((this.material.poisson = value)),
    });
    const pull = throttled(pause / 2, (share: number) => connection().send({ command: { set_gravity: { gravity: this.down.map((x) => share * x) } } }));
    this.gravity = addSlider(parent, { label: 'Gravity', lo: -1, hi: 2, value: 1, show: (value) => `${value.toFixed(2)} g`, change: pull });
    const pace = throttled(pause / 2, (speed: number) => connection().send({ speed }));
    this.speed = addSlider(parent, { label: 'Speed', lo: 0.02, hi: 2, value: 1, logarithmic: true, show: (value) => `${value.toFixed(2)} ×`, change: pace });
  }

  showScene({ materials, gravity, speed }: SceneFacts): void {
    Object.assign(this.material, materials[0]);
    this.young.set(this.material.young);
    this.poisson.set(this.material.poisson);
    this.down = Math.hypot(...gravity) > 0 ? gravity : [0, 0, -earth];
    this.gravity.set(Math.hypot(...gravity) > 0 ? 1 : 0);
    this.speed.set(speed);
  }

  showSpeed(speed: number): void {
    this.speed.set(speed);
  }

  /** As the tissue is now: undo and others change it, too. */
  follow({ materials, gravity, speed }: Status): void {
    this.young.follow(materials[0].young);
    this.poisson.follow(materials[0].poisson);
    this.gravity.follow(gravity.reduce((sum, x, i) => sum + x * this.down[i], 0) / this.down.reduce((sum, x) => sum + x * x, 0));
    this.speed.follow(speed);
  }
}
