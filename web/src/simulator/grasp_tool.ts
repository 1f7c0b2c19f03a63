// SPDX-License-Identifier: Apache-2.0
import { Plane, Vector3 } from 'three';
import type { GraspMarkers } from './overlays.ts';
import { pick } from './pick.ts';
import { arrayOf, type Room, type Tool } from './tool.ts';

interface Held {
  grasp: number;
  at: Vector3;
}

/** Pixels around a pin that belong to it. */
const reach = 14;
const mostGrasps = 1 << 20;

/** Takes tissue, pulls it in the plane of the screen, and lets it go or leaves it pinned. */
export class GraspTool implements Tool {
  private readonly room: Room;
  private readonly marks: GraspMarkers;
  private readonly pins: Held[] = [];
  private held: Held | undefined;
  private last = 0;

  constructor(room: Room, marks: GraspMarkers) {
    this.room = room;
    this.marks = marks;
  }

  wants(x: number, y: number): boolean {
    return this.pinAt(x, y) !== undefined || pick(this.room.body, this.room.stage.rayAt(x, y)) !== undefined;
  }

  hover(): void {}

  press(x: number, y: number): void {
    const pin = this.pinAt(x, y);
    if (pin) {
      this.pins.splice(this.pins.indexOf(pin), 1);
      this.letGo(pin);
      return;
    }
    const hit = pick(this.room.body, this.room.stage.rayAt(x, y));
    if (!hit) return;
    this.last = (this.last + 1) % mostGrasps;
    this.held = { grasp: this.last, at: hit.point };
    this.room.connection.send({ command: { grasp: { grasp: this.last, at: arrayOf(hit.point), radius: this.room.settings.radius } } });
    this.mark(this.held);
  }

  drag(x: number, y: number): void {
    if (!this.held) return;
    const { stage, connection } = this.room;
    const plane = new Plane().setFromNormalAndCoplanarPoint(stage.camera.getWorldDirection(new Vector3()), this.held.at);
    const to = stage.rayAt(x, y).intersectPlane(plane, new Vector3());
    if (!to) return;
    this.held.at = to;
    connection.send({ command: { move_grasp: { grasp: this.held.grasp, to: arrayOf(to) } } });
    this.mark(this.held);
  }

  release(): void {
    if (!this.held) return;
    if (this.room.settings.pin) {
      this.pins.push(this.held);
      this.mark(this.held);
    } else {
      this.letGo(this.held);
    }
    this.held = undefined;
  }

  rest(): void {}

  forget(): void {
    this.pins.length = 0;
    this.held = undefined;
    this.marks.clear();
  }

  private letGo(held: Held): void {
    this.room.connection.send({ command: { release: { grasp: held.grasp } } });
    this.marks.remove(held.grasp);
  }

  private mark(held: Held): void {
    this.marks.put(held.grasp, held.at, 0.6 * this.room.settings.radius, this.pins.includes(held));
  }

  private pinAt(x: number, y: number): Held | undefined {
    return this.pins.find((pin) => {
      const [px, py] = this.room.stage.screenOf(pin.at);
      return Math.hypot(px - x, py - y) < reach;
    });
  }
}
