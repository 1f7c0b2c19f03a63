// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { edgesOf } from '../src/simulator/overlays.ts';
import { decodeBinary, encodeUpload } from '../src/simulator/protocol.ts';
import { spread } from '../src/simulator/scalpel_tool.ts';

/** Vectors that the engine's tests hold to, too. */
function readVector(name: string): ArrayBuffer {
  const bytes = readFileSync(new URL(`../../../tests/server/data/${name}`, import.meta.url));
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) as ArrayBuffer;
}

test('a frame of the engine is decoded', () => {
  const decoded = decodeBinary(readVector('surface_frame.bin'));
  assert.ok('frame' in decoded);
  const { frame } = decoded;
  assert.deepEqual([frame.frame, frame.message, frame.scene, frame.time, frame.step], [7, 12, 3, 0.5, 400]);
  assert.deepEqual([frame.vertices, frame.triangles], [8, 12]); // a cube of six tets
  assert.equal(frame.position.length, 24);
  assert.deepEqual([...frame.position], [...frame.rest[0].values]); // at rest
  assert.ok([...frame.position].every((x) => x === 0 || x === 1));
  assert.ok([...frame.triangle[0].values].every((vertex) => vertex < 8));
  assert.ok([...frame.face[0].values].every((face) => face === 0));
  assert.equal(frame.node?.length, 24);
  assert.equal(frame.element?.length, 24);
  assert.equal(edgesOf(frame.element!, 8).length, 2 * 19); // 12 edges, 6 diagonals of faces, one of the cube
  for (let i = 0; i < frame.normal.length; i += 4) {
    assert.ok(Math.abs(Math.hypot(frame.normal[i], frame.normal[i + 1], frame.normal[i + 2]) / 32767 - 1) < 1e-3);
  }
  assert.ok([...frame.stress!].every((stress) => stress === 0));
});

test('bytes that are no frame, or part of one, are refused in words', () => {
  const whole = readVector('surface_frame.bin');
  for (let size = 0; size < whole.byteLength; size += 13) assert.throws(() => decodeBinary(whole.slice(0, size)), /engine/);
  const other = whole.slice(0);
  new DataView(other).setUint16(4, 2, true);
  assert.throws(() => decodeBinary(other), /another version/);
});

test('an upload is encoded as the engine reads it', () => {
  const encoded = encodeUpload('häma.msh', new TextEncoder().encode('$MeshFormat\n'));
  assert.deepEqual(new Uint8Array(encoded), new Uint8Array(readVector('upload.bin')));
});

test('a quick stroke is followed in small steps that end where the pointer is', () => {
  const places = spread([0, 0], [100, 0], 14);
  assert.equal(places.length, 8);
  assert.deepEqual(places.at(-1), [100, 0]);
  assert.deepEqual(spread([5, 5], [5, 5], 14), [[5, 5]]);
});
