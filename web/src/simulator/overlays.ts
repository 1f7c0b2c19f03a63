// SPDX-License-Identifier: Apache-2.0
import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, Group, Line, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshStandardMaterial,
  SphereGeometry, Vector3, type Camera, type Scene,
} from 'three';
import { bladeShape, handleShape, placeScalpel } from '../scalpel.ts';

/** The blade's edge: a segment from the handle's end to the free end. */
export interface Edge {
  heel: Vector3;
  tip: Vector3;
}

const accent = new Color(0x66d9c6);

/** The knife, solid while it cuts, a ghost before. */
export class ScalpelModel {
  private readonly group = new Group();
  private readonly steel = new MeshStandardMaterial({ color: 0xe2e6e8, metalness: 1, roughness: 0.3, envMapIntensity: 2.4 });
  private readonly grip = new MeshStandardMaterial({ color: 0xb9c0c4, metalness: 1, roughness: 0.42, envMapIntensity: 2.4 });
  private length = 0;

  constructor(scene: Scene) {
    this.group.matrixAutoUpdate = false;
    this.group.visible = false;
    scene.add(this.group);
  }

  show(edge: Edge, camera: Camera, ghost: boolean): void {
    const length = edge.heel.distanceTo(edge.tip);
    if (Math.abs(length - this.length) > 1e-3 * length) this.build(length);
    this.group.matrix.copy(placeScalpel(edge.heel, edge.tip, camera.position));
    this.group.matrixWorldNeedsUpdate = true;
    for (const material of [this.steel, this.grip]) {
      material.transparent = ghost;
      material.opacity = ghost ? 0.45 : 1;
    }
    this.group.visible = true;
  }

  hide(): void {
    this.group.visible = false;
  }

  private build(length: number): void {
    for (const part of this.group.children) (part as Mesh).geometry.dispose();
    this.group.clear();
    const blade = new Mesh(bladeShape(length), this.steel), handle = new Mesh(handleShape(length), this.grip);
    handle.castShadow = true;
    this.group.add(blade, handle);
    this.length = length;
  }
}

/** A line or a ribbon of points that come one after the other. */
class Trail {
  private readonly geometry = new BufferGeometry();
  private readonly values: Float32Array;
  private count = 0;

  constructor(most: number) {
    this.values = new Float32Array(3 * most);
    this.geometry.setAttribute('position', new BufferAttribute(this.values, 3));
    this.geometry.setDrawRange(0, 0);
  }

  get shape(): BufferGeometry {
    return this.geometry;
  }

  clear(): void {
    this.count = 0;
    this.geometry.setDrawRange(0, 0);
  }

  add(...points: Vector3[]): void {
    if (3 * (this.count + points.length) > this.values.length) return;
    for (const point of points) point.toArray(this.values, 3 * this.count++);
    this.geometry.attributes.position.needsUpdate = true;
  }

  draw(first: number, count: number): void {
    this.geometry.setDrawRange(first, count);
  }

  get points(): number {
    return this.count;
  }
}

const mostPoses = 4000;

/** Where a stroke has gone: the line of the incision on the skin, and the sheet that the edge has swept. */
export class StrokeTrace {
  private readonly line = new Trail(mostPoses);
  private readonly sheet = new Trail(6 * mostPoses);
  private readonly sheetMesh: Mesh;
  private last: Edge | undefined;

  constructor(scene: Scene) {
    const line = new Line(this.line.shape, new LineBasicMaterial({ color: accent, transparent: true, opacity: 0.8, depthTest: false }));
    this.sheetMesh = new Mesh(this.sheet.shape, new MeshBasicMaterial({ color: accent, side: DoubleSide, transparent: true, opacity: 0.35, depthWrite: false }));
    line.frustumCulled = this.sheetMesh.frustumCulled = false;
    line.renderOrder = 2;
    this.sheetMesh.visible = false;
    scene.add(line, this.sheetMesh);
  }

  start(): void {
    this.line.clear();
    this.sheet.clear();
    this.last = undefined;
  }

  /** `onSkin` is where the line goes on. */
  add(edge: Edge, onSkin?: Vector3): void {
    if (onSkin) this.line.add(onSkin);
    this.line.draw(0, this.line.points);
    if (this.last) {
      const { heel, tip } = this.last;
      this.sheet.add(heel, tip, edge.tip, heel, edge.tip, edge.heel);
      this.sheet.draw(0, this.sheet.points);
    }
    this.last = { heel: edge.heel.clone(), tip: edge.tip.clone() };
  }

  /** The line is a help while one cuts, the sheet is a view. */
  endLine(): void {
    this.line.clear();
  }

  showSheet(on: boolean): void {
    this.sheetMesh.visible = on;
  }
}

/** What a cut would be: a face between two edges, and a line to where the stroke heads. */
export class Plan {
  private readonly face = new BufferGeometry();
  private readonly group = new Group();

  constructor(scene: Scene) {
    this.face.setAttribute('position', new BufferAttribute(new Float32Array(12), 3));
    this.face.setIndex([0, 1, 2, 0, 2, 3]);
    const sheet = new Mesh(this.face, new MeshBasicMaterial({ color: accent, side: DoubleSide, transparent: true, opacity: 0.3, depthWrite: false }));
    const rim = new Line(this.face, new LineBasicMaterial({ color: accent }));
    sheet.frustumCulled = rim.frustumCulled = false;
    this.group.add(sheet);
    this.group.visible = false;
    scene.add(this.group);
  }

  show(from: Edge, to: Edge): void {
    const values = this.face.attributes.position.array as Float32Array;
    [from.heel, from.tip, to.tip, to.heel].forEach((point, i) => point.toArray(values, 3 * i));
    this.face.attributes.position.needsUpdate = true;
    this.group.visible = true;
  }

  hide(): void {
    this.group.visible = false;
  }
}

/** Balls where the tissue is held. */
export class GraspMarkers {
  private readonly shape = new SphereGeometry(1, 20, 12);
  private readonly free = new MeshBasicMaterial({ color: accent, transparent: true, opacity: 0.55, depthTest: false });
  private readonly pinned = new MeshBasicMaterial({ color: 0xf2c14e, transparent: true, opacity: 0.7, depthTest: false });
  private readonly marks = new Map<number, Mesh>();
  private readonly scene: Scene;

  constructor(scene: Scene) {
    this.scene = scene;
  }

  put(grasp: number, at: Vector3, radius: number, pinned: boolean): void {
    let mark = this.marks.get(grasp);
    if (!mark) {
      mark = new Mesh(this.shape, this.free);
      mark.renderOrder = 3;
      this.marks.set(grasp, mark);
      this.scene.add(mark);
    }
    mark.material = pinned ? this.pinned : this.free;
    mark.position.copy(at);
    mark.scale.setScalar(radius);
  }

  remove(grasp: number): void {
    const mark = this.marks.get(grasp);
    if (mark) this.scene.remove(mark);
    this.marks.delete(grasp);
  }

  clear(): void {
    for (const grasp of [...this.marks.keys()]) this.remove(grasp);
  }
}

/** The edges of the elements of S, as they move. */
export class ElementLines {
  private readonly geometry = new BufferGeometry();
  private readonly lines: LineSegments;
  private position = new BufferAttribute(new Float32Array(0), 3);

  constructor(scene: Scene) {
    this.lines = new LineSegments(this.geometry, new LineBasicMaterial({ color: 0xbfe8e0, transparent: true, opacity: 0.5 }));
    this.lines.frustumCulled = false;
    this.lines.visible = false;
    scene.add(this.lines);
  }

  show(on: boolean): void {
    this.lines.visible = on;
  }

  apply(node: Float32Array, element: Uint32Array | undefined): void {
    if (this.position.array.length !== node.length) {
      this.position = new BufferAttribute(new Float32Array(node.length), 3);
      this.geometry.setAttribute('position', this.position);
    }
    (this.position.array as Float32Array).set(node);
    this.position.needsUpdate = true;
    if (element) this.geometry.setIndex(new BufferAttribute(edgesOf(element, node.length / 3), 1));
  }
}

const sidesOfTet = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/** Each edge once. */
export function edgesOf(element: Uint32Array, nodes: number): Uint32Array {
  const seen = new Set<number>();
  const edges: number[] = [];
  for (let e = 0; e < element.length; e += 4) {
    for (const [i, j] of sidesOfTet) {
      const a = Math.min(element[e + i], element[e + j]), b = Math.max(element[e + i], element[e + j]);
      const key = a * nodes + b;
      if (seen.has(key)) continue;
      seen.add(key);
      edges.push(a, b);
    }
  }
  return Uint32Array.from(edges);
}
