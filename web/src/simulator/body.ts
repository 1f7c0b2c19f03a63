// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Sphere } from 'three';
import type { Frame, Rows } from './protocol.ts';

type Numbers = Float32Array | Int16Array | Uint32Array | Int32Array;

/** A table that is written in parts and has room to grow. */
class Table<T extends Numbers> {
  attribute: BufferAttribute;
  values: T;
  private readonly width: number;
  private readonly make: (size: number) => T;
  private readonly normalised: boolean;
  private readonly itemSize: number;

  /** `itemSize` as three.js counts: an index has single items, though a row is a triangle. */
  constructor(make: (size: number) => T, width: number, { normalised = false, itemSize = width } = {}) {
    this.make = make;
    this.width = width;
    this.normalised = normalised;
    this.itemSize = itemSize;
    this.values = make(0);
    this.attribute = this.wrap();
  }

  /** True if it had to move to a larger place. */
  reserve(rows: number): boolean {
    if (this.values.length >= rows * this.width) return false;
    const before = this.values;
    this.values = this.make(Math.ceil(1.5 * rows) * this.width);
    this.values.set(before);
    this.attribute = this.wrap();
    return true;
  }

  write(first: number, values: ArrayLike<number>): void {
    this.values.set(values, first * this.width);
    this.touch(first, values.length / this.width);
  }

  /** Has the rows sent to the graphics processor. */
  touch(first: number, rows: number): void {
    this.attribute.addUpdateRange(first * this.width, rows * this.width);
    this.attribute.needsUpdate = true;
  }

  private wrap(): BufferAttribute {
    const attribute = new BufferAttribute(this.values, this.itemSize, this.normalised);
    attribute.setUsage(DynamicDrawUsage);
    attribute.onUpload(() => attribute.clearUpdateRanges());
    return attribute;
  }
}

/** The surface as the frames leave it: what is drawn, and what rays are tried against. */
export class Body {
  readonly geometry = new BufferGeometry();
  vertices = 0;
  triangles = 0;
  readonly position = new Table((n) => new Float32Array(n), 3);
  readonly rest = new Table((n) => new Float32Array(n), 3);
  readonly stress = new Table((n) => new Float32Array(n), 1);
  readonly index = new Table((n) => new Uint32Array(n), 3, { itemSize: 1 });
  readonly face = new Table((n) => new Int32Array(n), 1);
  readonly piece = new Table((n) => new Int32Array(n), 1);
  private readonly normal = new Table((n) => new Int16Array(n), 4, { normalised: true });
  private readonly inside = new Table((n) => new Float32Array(n), 1);
  private readonly pieceOfVertex = new Table((n) => new Float32Array(n), 1);

  constructor() {
    this.geometry.boundingSphere = new Sphere(undefined, Infinity);
  }

  get normals(): Int16Array {
    return this.normal.values;
  }

  apply(frame: Frame): void {
    this.reserve(frame);
    this.position.write(0, frame.position);
    this.normal.write(0, frame.normal);
    if (frame.stress) this.stress.write(0, frame.stress);
    for (const rows of frame.rest) this.rest.write(rows.first, rows.values);
    for (const rows of frame.triangle) this.index.write(rows.first, rows.values);
    for (const rows of frame.face) this.face.write(rows.first, rows.values);
    for (const rows of frame.piece) this.piece.write(rows.first, rows.values);
    this.vertices = frame.vertices;
    this.triangles = frame.triangles;
    for (const rows of frame.triangle) this.markVertices(rows);
    this.geometry.setDrawRange(0, 3 * frame.triangles);
  }

  private reserve(frame: Frame): void {
    let moved = false;
    for (const table of [this.position, this.normal, this.rest, this.stress, this.inside, this.pieceOfVertex]) {
      moved = table.reserve(frame.vertices) || moved;
    }
    for (const table of [this.index, this.face, this.piece]) moved = table.reserve(frame.triangles) || moved;
    if (!moved) return;
    this.geometry.setAttribute('position', this.position.attribute);
    this.geometry.setAttribute('normal', this.normal.attribute);
    this.geometry.setAttribute('rest', this.rest.attribute);
    this.geometry.setAttribute('stress', this.stress.attribute);
    this.geometry.setAttribute('inside', this.inside.attribute);
    this.geometry.setAttribute('piece', this.pieceOfVertex.attribute);
    this.geometry.setIndex(this.index.attribute);
  }

  /** What triangles say of themselves goes to their vertices, which all say the same. */
  private markVertices(rows: Rows<Uint32Array>): void {
    if (rows.rows === 0) return;
    let lowest = Infinity, highest = 0;
    for (let corner = 0; corner < rows.values.length; ++corner) {
      const vertex = rows.values[corner];
      const triangle = rows.first + Math.floor(corner / 3);
      this.inside.values[vertex] = this.face.values[triangle] === 0 ? 0 : 1;
      this.pieceOfVertex.values[vertex] = this.piece.values[triangle];
      lowest = Math.min(lowest, vertex);
      highest = Math.max(highest, vertex);
    }
    this.inside.touch(lowest, highest - lowest + 1);
    this.pieceOfVertex.touch(lowest, highest - lowest + 1);
  }
}
