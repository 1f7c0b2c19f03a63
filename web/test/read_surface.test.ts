// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { readSurface } from '../src/read_surface.ts';

// The tests run in web/, as npm test does.
const load = (name: string) => new Uint8Array(readFileSync(`test/data/${name}`));
const read = (name: string) => readSurface(name, load(name));
const text = (content: string) => new TextEncoder().encode(content);

const asciiTriangle = (changes: [string, string][] = []) => {
  const plain = `<VTKFile byte_order='LittleEndian' type='PolyData'>
<PolyData><Piece NumberOfPolys="1" NumberOfPoints="4">
<Points><DataArray NumberOfComponents="3" type="Float64">0 0 0  1 0 0  1 1 0  0 1 0</DataArray></Points>
<CellData><DataArray Name="face" format="ascii" type="Int32">-2</DataArray></CellData>
<Polys><DataArray type="Int32" Name="offsets" format="ascii">4</DataArray>
<DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 3</DataArray></Polys>
</Piece></PolyData></VTKFile>`;
  return text(changes.reduce((file, [from, to]) => file.replace(from, to), plain));
};

test('a raw .vtp gives deformed points, rest points, triangles and faces', () => {
  const cube = read('cube.vtp');
  assert.equal(cube.points.length, 24);
  assert.equal(cube.triangles.length, 36);
  assert.deepEqual([...cube.points.slice(21)].map((c) => c.toFixed(3)), ['0.120', '0.100', '0.100']);
  assert.deepEqual([...cube.rest.slice(21)].map((c) => c.toFixed(3)), ['0.100', '0.100', '0.100']);
  assert.deepEqual([...cube.triangles.slice(0, 6)], [0, 2, 3, 0, 3, 1]);
  assert.deepEqual([...cube.face], [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, -1, -1]);
});

test('the .obj of the same cube has the same shape and one skin', () => {
  const cube = read('cube.obj'), same = read('cube.vtp');
  assert.deepEqual([...cube.triangles], [...same.triangles]);
  cube.points.forEach((c, i) => assert.ok(Math.abs(c - same.points[i]) < 1e-6));
  assert.ok(cube.face.every((side) => side === 0));
});

test('an .obj may name normals and textures, polygons, and points from the end', () => {
  const surface = readSurface('a.obj', text('# quad\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\r\nv 0 1 0\nvn 0 0 1\nf 1/1/1 2//1 3/3 -1\n'));
  assert.deepEqual([...surface.triangles], [0, 1, 2, 0, 2, 3]);
});

test('an ascii .vtp with other order of attributes, doubles and a quad is read', () => {
  const surface = readSurface('a.vtp', asciiTriangle());
  assert.deepEqual([...surface.triangles], [0, 1, 2, 0, 2, 3]);
  assert.deepEqual([...surface.face], [-2, -2]);
  assert.deepEqual(surface.rest, surface.points);
});

test('files that cannot be drawn are refused with the reason', () => {
  const refuse = (name: string, bytes: Uint8Array, reason: RegExp) => assert.throws(() => readSurface(name, bytes), reason);
  refuse('a.stl', text(''), /give a \.vtp or \.obj/);
  refuse('a.obj', text('v 0 0 0\n'), /no triangles/);
  refuse('a.obj', text('v 0 0\n'), /line 1: 'v' needs three numbers/);
  refuse('a.obj', text('v 0 0 0\nf 1 x 1\n'), /line 2: 'x' names no point/);
  refuse('a.obj', text('v 0 0 0\nf 1 2 3\n'), /names point 1, but there are 1 points/);
  refuse('a.vtp', text('solid'), /not VTK PolyData/);
  refuse('a.vtp', asciiTriangle([['LittleEndian', 'BigEndian']]), /big endian/);
  refuse('a.vtp', asciiTriangle([['"connectivity"', '"other"']]), /<Polys> holds no array 'connectivity'/);
  refuse('a.vtp', asciiTriangle([['0 0 0  1', 'nan 0 0  1']]), /not a finite number/);
  refuse('a.vtp', load('cube.vtp').slice(0, 1500), /cut short/);
});
