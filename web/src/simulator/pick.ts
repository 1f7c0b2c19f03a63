// SPDX-License-Identifier: Apache-2.0
import { Ray, Vector3 } from 'three';
import type { Body } from './body.ts';

export interface Hit {
  point: Vector3;
  /** Outwards, smooth. */
  normal: Vector3;
  triangle: number;
  /** Weights of the triangle's corners. */
  weights: [number, number, number];
  distance: number;
}

/** The nearest triangle that the ray meets from outside (Moeller and Trumbore 1997); `skinOnly` leaves out cut faces. */
export function pick(body: Body, ray: Ray, skinOnly = false): Hit | undefined {
  const x = body.position.values, index = body.index.values, face = body.face.values;
  const { origin: o, direction: d } = ray;
  let best = -1, nearest = Infinity, bestU = 0, bestV = 0;
  for (let t = 0; t < body.triangles; ++t) {
    if (skinOnly && face[t] !== 0) continue;
    const a = 3 * index[3 * t], b = 3 * index[3 * t + 1], c = 3 * index[3 * t + 2];
    const ux = x[b] - x[a], uy = x[b + 1] - x[a + 1], uz = x[b + 2] - x[a + 2];
    const vx = x[c] - x[a], vy = x[c + 1] - x[a + 1], vz = x[c + 2] - x[a + 2];
    const px = d.y * vz - d.z * vy, py = d.z * vx - d.x * vz, pz = d.x * vy - d.y * vx;
    const determinant = ux * px + uy * py + uz * pz;
    if (determinant <= 0) continue;
    const sx = o.x - x[a], sy = o.y - x[a + 1], sz = o.z - x[a + 2];
    const u = (sx * px + sy * py + sz * pz) / determinant;
    if (u < 0 || u > 1) continue;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const v = (d.x * qx + d.y * qy + d.z * qz) / determinant;
    if (v < 0 || u + v > 1) continue;
    const distance = (vx * qx + vy * qy + vz * qz) / determinant;
    if (distance <= 0 || distance >= nearest) continue;
    nearest = distance;
    best = t;
    bestU = u;
    bestV = v;
  }
  if (best < 0) return undefined;
  const weights: [number, number, number] = [1 - bestU - bestV, bestU, bestV];
  return {
    point: ray.at(nearest, new Vector3()),
    normal: mixAt(body, best, weights, body.normals, 4).normalize(),
    triangle: best,
    weights,
    distance: nearest,
  };
}

/** Three numbers of a table with rows of `width`, mixed over a triangle. */
export function mixAt(body: Body, triangle: number, weights: [number, number, number], table: ArrayLike<number>, width: number): Vector3 {
  const mixed = new Vector3();
  for (let k = 0; k < 3; ++k) {
    const row = width * body.index.values[3 * triangle + k];
    mixed.x += weights[k] * table[row];
    mixed.y += weights[k] * table[row + 1];
    mixed.z += weights[k] * table[row + 2];
  }
  return mixed;
}
