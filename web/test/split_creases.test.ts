// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { readVtp } from '../src/read_vtp.ts';
import { splitCreases } from '../src/split_creases.ts';
import type { Surface } from '../src/surface.ts';

/** Two squares that meet in one edge, the second folded up by the angle. */
function folded(degrees: number, face: number[]): Surface {
  const c = Math.cos((degrees * Math.PI) / 180), s = Math.sin((degrees * Math.PI) / 180);
  const points = Float32Array.of(0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1 + c, 0, s, 1 + c, 1, s);
  return { points, rest: points, triangles: Uint32Array.of(0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2), face: Int32Array.from(face) };
}

test('a cube is split at its edges and has one normal per side', () => {
  const cube = readVtp(new Uint8Array(readFileSync('test/data/cube.vtp')));
  const mesh = splitCreases(cube);
  assert.equal(mesh.inside.length, 24);
  assert.deepEqual([...mesh.normal.slice(0, 3)].map(Math.round), [0, 0, -1]);
  assert.equal(mesh.inside.filter((x) => x === 1).length, 8);
});

test('a soft fold stays smooth, a sharp one is split', () => {
  assert.equal(splitCreases(folded(30, [0, 0, 0, 0])).inside.length, 6);
  assert.equal(splitCreases(folded(90, [0, 0, 0, 0])).inside.length, 8);
});

test('the lip between skin and sheet is split even where it is flat, the sheet itself never', () => {
  assert.equal(splitCreases(folded(0, [0, 0, 1, 1])).inside.length, 8);
  assert.equal(splitCreases(folded(0, [1, 1, -1, -1])).inside.length, 8);
  assert.equal(splitCreases(folded(90, [1, 1, 1, 1])).inside.length, 6);
});

test('bending makes no crease: sharpness is judged at rest', () => {
  const bent = { ...folded(90, [0, 0, 0, 0]), rest: folded(0, [0, 0, 0, 0]).points };
  assert.equal(splitCreases(bent).inside.length, 6);
});

test('normals have length one and point outwards on a fan of uneven triangles', () => {
  const mesh = splitCreases(folded(20, [0, 0, 0, 0]));
  for (let i = 0; i < mesh.normal.length; i += 3) {
    assert.ok(Math.abs(Math.hypot(mesh.normal[i], mesh.normal[i + 1], mesh.normal[i + 2]) - 1) < 1e-6);
    assert.ok(mesh.normal[i + 2] > 0.9);
  }
});
