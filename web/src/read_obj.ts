// SPDX-License-Identifier: Apache-2.0
import { checkSurface, triangulate, type Surface } from './surface.ts';

/** Reads the `v` and `f` lines of a Wavefront OBJ file; everything else is skipped. */
export function readObj(bytes: Uint8Array): Surface {
  const points: number[] = [];
  const polygons: number[][] = [];
  const lines = new TextDecoder().decode(bytes).split('\n');
  lines.forEach((line, index) => {
    const [word, ...rest] = line.trim().split(/\s+/);
    if (word === 'v') points.push(...readPoint(rest, index + 1));
    else if (word === 'f') polygons.push(rest.map((corner) => readCorner(corner, points.length / 3, index + 1)));
  });
  const positions = Float32Array.from(points);
  return checkSurface({ points: positions, rest: positions, ...triangulate(polygons, undefined) });
}

function readPoint(words: string[], line: number): number[] {
  const xyz = words.slice(0, 3).map(Number);
  if (xyz.length < 3 || xyz.some(Number.isNaN)) throw new Error(`line ${line}: 'v' needs three numbers`);
  return xyz;
}

/** A corner is `a`, `a/b`, `a//c` or `a/b/c`; only the point matters. Negative numbers count from the last point. */
function readCorner(corner: string, pointsSoFar: number, line: number): number {
  const number = Number(corner.split('/')[0]);
  if (!Number.isInteger(number) || number === 0) throw new Error(`line ${line}: '${corner}' names no point`);
  const index = number > 0 ? number - 1 : pointsSoFar + number;
  if (index < 0) throw new Error(`line ${line}: '${corner}' names no point`);
  return index;
}
