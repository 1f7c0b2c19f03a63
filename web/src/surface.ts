// SPDX-License-Identifier: Apache-2.0

/** A triangle surface as the engine writes it: one point per material vertex, in metres, z up. */
export interface Surface {
  /** Deformed positions, xyz per point. */
  points: Float32Array;
  /** Rest positions, xyz per point; equal to `points` where the file has none. */
  rest: Float32Array;
  /** Three point numbers per triangle. */
  triangles: Uint32Array;
  /** Per triangle: 0 for the outer skin, +k and -k for the two sides of the sheet of stroke k. */
  face: Int32Array;
}

/** Refuses a surface that cannot be drawn, so that the picture never shows half a body without a word. */
export function checkSurface(surface: Surface): Surface {
  const count = surface.points.length / 3;
  if (surface.triangles.length === 0) throw new Error('it holds no triangles; give a closed surface');
  for (const v of surface.triangles) {
    if (v >= count) throw new Error(`a triangle names point ${v}, but there are ${count} points; the file is damaged`);
  }
  for (const x of surface.points) {
    if (!Number.isFinite(x)) throw new Error('a coordinate is not a finite number; the simulation that wrote it diverged');
  }
  return surface;
}

/** Cuts polygons into fans; `face` of a polygon goes to each of its triangles. */
export function triangulate(polygons: ArrayLike<number>[], faceOf: ArrayLike<number> | undefined) {
  const triangles: number[] = [];
  const face: number[] = [];
  polygons.forEach((polygon, cell) => {
    for (let i = 2; i < polygon.length; ++i) {
      triangles.push(polygon[0], polygon[i - 1], polygon[i]);
      face.push(faceOf ? faceOf[cell] : 0);
    }
  });
  return { triangles: Uint32Array.from(triangles), face: Int32Array.from(face) };
}
