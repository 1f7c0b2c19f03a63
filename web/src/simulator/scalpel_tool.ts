// SPDX-License-Identifier: Apache-2.0
import { Plane, Quaternion, Vector3 } from 'three';
import { Plan, StrokeTrace, type Edge, type ScalpelModel } from './overlays.ts';
import { pick } from './pick.ts';
import { arrayOf, type Room, type Tool } from './tool.ts';

/** Pixels between two places of a stroke at which the skin is looked for. */
const stride = 14;
/** Of the blade above the skin, as a part of the body's radius. */
const above = 0.22;

interface Place {
  point: Vector3;
  normal: Vector3;
}

/** Places from one pointer position to the next, the last one included, so that quick strokes follow the skin, too. */
export function spread(from: [number, number], to: [number, number], apart: number): [number, number][] {
  const steps = Math.max(1, Math.ceil(Math.hypot(to[0] - from[0], to[1] - from[1]) / apart));
  return Array.from({ length: steps }, (_, i) => {
    const t = (i + 1) / steps;
    return [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])];
  });
}

/** Press on the skin and drag: the tip follows below it. */
export class ScalpelTool implements Tool {
  private readonly room: Room;
  private readonly model: ScalpelModel;
  private readonly trace: StrokeTrace;
  private readonly plan: Plan;
  private last: Place | undefined;
  private at: [number, number] = [0, 0];
  private cutting = false;
  /** Of the tip's way. */
  private readonly heading = new Vector3(1, 0, 0);

  constructor(room: Room, model: ScalpelModel, trace: StrokeTrace) {
    this.room = room;
    this.model = model;
    this.trace = trace;
    this.plan = new Plan(room.stage.scene);
  }

  wants(x: number, y: number): boolean {
    return pick(this.room.body, this.room.stage.rayAt(x, y)) !== undefined;
  }

  hover(x: number, y: number): void {
    const hit = pick(this.room.body, this.room.stage.rayAt(x, y));
    if (!hit) {
      this.rest();
      return;
    }
    this.heading.setFromMatrixColumn(this.room.stage.camera.matrixWorld, 0);
    const edge = this.edgeAt(hit);
    this.model.show(edge, this.room.stage.camera, true);
    this.showAhead(edge);
  }

  press(x: number, y: number): void {
    const hit = pick(this.room.body, this.room.stage.rayAt(x, y));
    if (!hit) return;
    this.heading.setFromMatrixColumn(this.room.stage.camera.matrixWorld, 0);
    this.at = [x, y];
    this.cutting = true;
    this.last = undefined;
    this.trace.start();
    this.move(hit);
  }

  drag(x: number, y: number): void {
    if (!this.cutting) return;
    if (Math.hypot(x - this.at[0], y - this.at[1]) < 1) return;
    for (const place of spread(this.at, [x, y], stride)) this.move(this.follow(place));
    this.at = [x, y];
  }

  release(): void {
    if (!this.cutting) return;
    this.cutting = false;
    this.room.connection.send({ command: { lift_blade: { blade: 0, complete: false } } });
    this.trace.endLine();
    this.rest();
  }

  rest(): void {
    this.model.hide();
    this.plan.hide();
  }

  forget(): void {
    this.cutting = false;
    this.trace.start();
  }

  /** On the skin, or where it has been left on its last tangent plane: a cut may run out over the edge. */
  private follow([x, y]: [number, number]): Place {
    const ray = this.room.stage.rayAt(x, y);
    const hit = pick(this.room.body, ray, true);
    const before = this.last!;
    const near = 0.5 * this.room.stage.bounds.radius;
    if (hit && hit.point.distanceTo(before.point) < near) {
      return { point: hit.point, normal: before.normal.clone().multiplyScalar(2).add(hit.normal).normalize() };
    }
    const plane = new Plane().setFromNormalAndCoplanarPoint(before.normal, before.point);
    const point = ray.intersectPlane(plane, new Vector3());
    return { point: point && point.distanceTo(before.point) < near ? point : before.point, normal: before.normal };
  }

  private move(place: Place): void {
    if (this.last) {
      const way = place.point.clone().sub(this.last.point);
      if (way.length() > 1e-4) this.heading.lerp(way.normalize(), 0.5).normalize();
    }
    this.last = { point: place.point.clone(), normal: place.normal.clone() };
    const edge = this.edgeAt(place);
    this.room.connection.send({ command: { move_blade: { blade: 0, heel: arrayOf(edge.heel), tip: arrayOf(edge.tip) } } });
    this.model.show(edge, this.room.stage.camera, false);
    this.trace.add(edge, place.point);
    this.showAhead(edge);
  }

  /** How the blade stands at a place of the skin. */
  private edgeAt(place: Place): Edge {
    const { settings, stage } = this.room;
    const out = settings.alongView
      ? stage.camera.position.clone().sub(place.point).normalize()
      : place.normal.clone();
    if (settings.lean !== 0) out.applyQuaternion(new Quaternion().setFromAxisAngle(this.heading, settings.lean));
    return {
      heel: place.point.clone().addScaledVector(out, above * stage.bounds.radius),
      tip: place.point.clone().addScaledVector(out, -settings.depth),
    };
  }

  /** What the blade will cut if it goes on as it goes. */
  private showAhead(edge: Edge): void {
    const ahead = this.heading.clone().multiplyScalar(0.12 * this.room.stage.bounds.radius);
    const surface = edge.tip.clone().lerp(edge.heel, this.room.settings.depth / edge.heel.distanceTo(edge.tip));
    const from = { heel: surface, tip: edge.tip };
    this.plan.show(from, { heel: surface.clone().add(ahead), tip: edge.tip.clone().add(ahead) });
  }
}
