// SPDX-License-Identifier: Apache-2.0
import { Plan, type Edge, type StrokeTrace } from './overlays.ts';
import { arrayOf, type Room, type Tool } from './tool.ts';

/** Of the blade, from one end of the line to the other, in poses that a page draws one by one if it is quick enough. */
const seconds = 0.67, poses = 40;

/** Two points on the screen: a blade along the view goes from one to the other, right through the body. */
export class LineTool implements Tool {
  private readonly room: Room;
  private readonly trace: StrokeTrace;
  private readonly plan: Plan;
  private start: [number, number] | undefined;
  private way: Edge[] = [];
  /** Poses that it is time for, at the last tick. */
  private due = 0;
  private ticked = 0;
  private readonly speed: () => number;

  /** `speed` is that of the blade's clock: slow motion slows it, too. */
  constructor(room: Room, trace: StrokeTrace, speed: () => number) {
    this.room = room;
    this.trace = trace;
    this.speed = speed;
    this.plan = new Plan(room.stage.scene);
  }

  wants(): boolean {
    return this.way.length === 0;
  }

  hover(): void {}

  press(x: number, y: number): void {
    this.start = [x, y];
  }

  drag(x: number, y: number): void {
    if (this.start) this.plan.show(this.edgeAt(...this.start), this.edgeAt(x, y));
  }

  release(x: number, y: number): void {
    const from = this.start;
    this.start = undefined;
    this.plan.hide();
    if (!from || Math.hypot(x - from[0], y - from[1]) < 8) return;
    const a = this.edgeAt(...from), b = this.edgeAt(x, y);
    this.way = Array.from({ length: poses + 1 }, (_, i) => ({
      heel: a.heel.clone().lerp(b.heel, i / poses),
      tip: a.tip.clone().lerp(b.tip, i / poses),
    }));
    this.due = 1;
    this.ticked = performance.now();
    this.trace.start();
  }

  tick(): void {
    if (this.way.length === 0) return;
    const now = performance.now();
    this.due += ((poses / seconds) * this.speed() * (now - this.ticked)) / 1000;
    this.ticked = now;
    for (; this.due >= 1 && this.way.length > 0; --this.due) this.goTo(this.way.shift()!);
  }

  private goTo(edge: Edge): void {
    this.room.connection.send({ command: { move_blade: { blade: 0, heel: arrayOf(edge.heel), tip: arrayOf(edge.tip) } } });
    this.trace.add(edge);
    if (this.way.length > 0) return;
    this.room.connection.send({ command: { lift_blade: { blade: 0, complete: false } } });
    this.trace.endLine();
  }

  rest(): void {
    this.start = undefined;
    this.plan.hide();
  }

  forget(): void {
    this.way = [];
    this.rest();
  }

  /** The view's ray here, as far as it can meet the body. */
  private edgeAt(x: number, y: number): Edge {
    const { stage } = this.room;
    const ray = stage.rayAt(x, y);
    const away = stage.bounds.center.distanceTo(stage.camera.position);
    const reach = 1.6 * stage.bounds.radius;
    const point = (distance: number) => ray.at(Math.max(distance, 0.05 * away), ray.origin.clone());
    return { heel: point(away - reach), tip: point(away + reach) };
  }
}
