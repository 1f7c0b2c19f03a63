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
  const patch = joinCorners(surface, faceNormals(rest, triangles));
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
  const { triangles, face, points } = surface;
  const count = points.length / 3;
  const parent = Uint32Array.from(triangles, (_, corner) => corner);
  const root = (i: number): number => {
    while (parent[i] !== i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const smooth = (s: number, t: number) =>
    face[s] === face[t] &&
    (face[s] !== 0 || dotOf(normals, s, t) > creaseCosine);
  const edges = new Map<number, number[]>();
  triangles.forEach((a, corner) => {
    const t = Math.floor(corner / 3);
    const next = 3 * t + ((corner + 1) % 3);
    const b = triangles[next];
    const key = Math.min(a, b) * count + Math.max(a, b);
    const mates = edges.get(key) ?? [];
    if (mates.length === 0) edges.set(key, mates);
    for (const mate of mates) {
      const s = Math.floor(mate / 3);
      if (!smooth(s, t)) continue;
      const mateNext = 3 * s + ((mate + 1) % 3);
      const swapped = triangles[mate] !== a;
      parent[root(corner)] = root(swapped ? mateNext : mate);
      parent[root(next)] = root(swapped ? mate : mateNext);
    }
    mates.push(corner);
  });
  return root;
}

function dotOf(normals: Float32Array, s: number, t: number): number {
  return normals[3 * s] * normals[3 * t] + normals[3 * s + 1] * normals[3 * t + 1] + normals[3 * s + 2] * normals[3 * t + 2];
}

function edgeVector(x: Float32Array, from: number, to: number): [number, number, number] {
  return [x[3 * to] - x[3 * from], x[3 * to + 1] - x[3 * from + 1], x[3 * to + 2] - x[3 * from + 2]];
}

function faceNormals(x: Float32Array, triangles: Uint32Array): Float32Array {
  const normals = new Float32Array(triangles.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const u = edgeVector(x, triangles[i], triangles[i + 1]);
    const v = edgeVector(x, triangles[i], triangles[i + 2]);
    normals.set([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]], i);
  }
  normalise(normals);
  return normals;
}

/** Face normals weighted by the corner's angle, so that the slivers of a cut do not pull the shading about. */
function cornerNormals(x: Float32Array, triangles: Uint32Array): Float32Array {
  const faces = faceNormals(x, triangles);
  const corners = new Float32Array(3 * triangles.length);
  triangles.forEach((point, corner) => {
    const t = Math.floor(corner / 3);
    const u = edgeVector(x, point, triangles[3 * t + ((corner + 1) % 3)]);
    const v = edgeVector(x, point, triangles[3 * t + ((corner + 2) % 3)]);
    const lengths = Math.hypot(...u) * Math.hypot(...v);
    const cosine = lengths > 0 ? (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) / lengths : 1;
    const angle = Math.acos(Math.min(1, Math.max(-1, cosine)));
    for (let k = 0; k < 3; ++k) corners[3 * corner + k] = angle * faces[3 * t + k];
  });
  return corners;
}

function normalise(vectors: Float32Array): void {
  for (let i = 0; i < vectors.length; i += 3) {
    const length = Math.hypot(vectors[i], vectors[i + 1], vectors[i + 2]) || 1;
    for (let k = 0; k < 3; ++k) vectors[i + k] /= length;
  }
}
