// SPDX-License-Identifier: Apache-2.0
import type { Surface } from './surface.ts';

/** What the renderer draws: points split wherever the shading must break. */
export interface Mesh {
  position: Float32Array;
  normal: Float32Array;
  rest: Float32Array;
  /** 1 on the faces that a blade opened, 0 on the outer skin. */
  inside: Float32Array;
  index: Uint32Array;
}

/** Edges sharper than this at rest are edges of the body, such as a block's, and stay crisp. */
const creaseCosine = Math.cos((50 * Math.PI) / 180);

/**
 * Gives every point one normal per smooth patch around it. A patch ends where skin meets sheet, where one side of a
 * sheet meets the other, and at edges that are sharp at rest: bending never makes a crease.
 */
export function splitCreases(surface: Surface): Mesh {
  const { points, rest, triangles, face } = surface;
  const patch = joinCorners(surface, steadyNormals(rest, triangles));
  const normals = cornerNormals(points, triangles);
  const splitOf = new Map<number, number>();
  const source: number[] = [];
  const index = new Uint32Array(triangles.length);
  triangles.forEach((_, corner) => {
    const root = patch(corner);
    let split = splitOf.get(root);
    if (split === undefined) splitOf.set(root, (split = source.push(corner) - 1));
    index[corner] = split;
  });
  const mesh: Mesh = {
    position: new Float32Array(3 * source.length),
    normal: new Float32Array(3 * source.length),
    rest: new Float32Array(3 * source.length),
    inside: new Float32Array(source.length),
    index,
  };
  source.forEach((corner, split) => {
    const from = 3 * triangles[corner];
    mesh.position.set(points.subarray(from, from + 3), 3 * split);
    mesh.rest.set(rest.subarray(from, from + 3), 3 * split);
    mesh.inside[split] = face[Math.floor(corner / 3)] === 0 ? 0 : 1;
  });
  index.forEach((split, corner) => {
    for (let k = 0; k < 3; ++k) mesh.normal[3 * split + k] += normals[3 * corner + k];
  });
  normalise(mesh.normal);
  return mesh;
}

/** Unites the corners of a point that see each other across a smooth edge; answers the patch of a corner. */
function joinCorners(surface: Surface, normals: Float32Array): (corner: number) => number {
  const { triangles, face } = surface;
  const parent = Uint32Array.from(triangles, (_, corner) => corner);
  const root = (i: number): number => {
    while (parent[i] !== i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const smooth = (s: number, t: number) =>
    face[s] === face[t] &&
    (face[s] !== 0 || dotOf(normals, s, t) > creaseCosine);
  forEachEdge(triangles, (corner, mate) => {
    if (!smooth(Math.floor(mate / 3), Math.floor(corner / 3))) return;
    const swapped = triangles[mate] !== triangles[corner];
    parent[root(corner)] = root(swapped ? following(mate) : mate);
    parent[root(following(corner))] = root(swapped ? mate : following(mate));
  });
  return root;
}

/** The next corner of the same triangle; a corner also names the edge that leaves it. */
function following(corner: number): number {
  return corner % 3 === 2 ? corner - 2 : corner + 1;
}

/** Visits every pair of triangle sides that lie on one edge. */
function forEachEdge(triangles: Uint32Array, visit: (corner: number, mate: number) => void): void {
  const count = triangles.reduce((most, point) => Math.max(most, point), 0) + 1;
  const last = new Map<number, number>();
  const before = new Int32Array(triangles.length);
  triangles.forEach((a, corner) => {
    const b = triangles[following(corner)];
    const key = Math.min(a, b) * count + Math.max(a, b);
    before[corner] = last.get(key) ?? -1;
    for (let mate = before[corner]; mate >= 0; mate = before[mate]) visit(corner, mate);
    last.set(key, corner);
  });
}

function dotOf(normals: Float32Array, s: number, t: number): number {
  return normals[3 * s] * normals[3 * t] + normals[3 * s + 1] * normals[3 * t + 1] + normals[3 * s + 2] * normals[3 * t + 2];
}

function edgeVector(x: Float32Array, from: number, to: number): [number, number, number] {
  return [x[3 * to] - x[3 * from], x[3 * to + 1] - x[3 * from + 1], x[3 * to + 2] - x[3 * from + 2]];
}

/** Twice the area, along the normal. */
function areaVectors(x: Float32Array, triangles: Uint32Array): Float32Array {
  const vectors = new Float32Array(triangles.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const u = edgeVector(x, triangles[i], triangles[i + 1]);
    const v = edgeVector(x, triangles[i], triangles[i + 2]);
    vectors.set([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]], i);
  }
  return vectors;
}

/**
 * Face normals with the weights of Max (1999), sin(angle) / (product of the two sides): exact on a sphere however
 * unevenly it is cut into triangles. With weights by angle or area the wet film mirrors every triangle of the lattice.
 */
function cornerNormals(x: Float32Array, triangles: Uint32Array): Float32Array {
  const areas = areaVectors(x, triangles);
  const corners = new Float32Array(3 * triangles.length);
  triangles.forEach((point, corner) => {
    const next = following(corner);
    const u = edgeVector(x, point, triangles[next]), v = edgeVector(x, point, triangles[following(next)]);
    const weight = 1 / ((u[0] ** 2 + u[1] ** 2 + u[2] ** 2) * (v[0] ** 2 + v[1] ** 2 + v[2] ** 2));
    // Two points in one place give no direction.
    if (!Number.isFinite(weight)) return;
    for (let k = 0; k < 3; ++k) corners[3 * corner + k] = weight * areas[3 * Math.floor(corner / 3) + k];
  });
  return corners;
}

/** Unit normals in which a sliver, whose own normal says little, takes that of its largest neighbours. */
function steadyNormals(x: Float32Array, triangles: Uint32Array): Float32Array {
  const own = areaVectors(x, triangles);
  const shared = own.slice();
  const length = (t: number) => Math.hypot(own[3 * t], own[3 * t + 1], own[3 * t + 2]);
  forEachEdge(triangles, (corner, mate) => {
    const s = Math.floor(mate / 3), t = Math.floor(corner / 3);
    for (const [to, from] of [[s, t], [t, s]]) {
      if (length(to) * 8 < length(from)) for (let k = 0; k < 3; ++k) shared[3 * to + k] += own[3 * from + k];
    }
  });
  normalise(shared);
  return shared;
}

function normalise(vectors: Float32Array): void {
  for (let i = 0; i < vectors.length; i += 3) {
    const length = Math.hypot(vectors[i], vectors[i + 1], vectors[i + 2]) || 1;
    for (let k = 0; k < 3; ++k) vectors[i + k] /= length;
  }
}
