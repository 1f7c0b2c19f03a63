// SPDX-License-Identifier: Apache-2.0
// Writes the cube that the tests read, in the engine's own layout: node test/write_cube.mjs
import { writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const data = join(dirname(fileURLToPath(import.meta.url)), 'data');
const side = 0.1;
const rest = Array.from({ length: 8 }, (_, i) => [i & 1, (i >> 1) & 1, i >> 2].map((c) => c * side)).flat();
// The deformed cube is sheared, so that a reader which mixes up the two arrays is found out.
const points = rest.map((c, i) => (i % 3 === 0 ? c + 0.2 * rest[i + 2] : c));
const quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
const triangles = quads.flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]]);
// The last two sides stand for the two sides of the sheet of stroke 1.
const face = triangles.map((_, t) => (t < 8 ? 0 : t < 10 ? 1 : -1));

const arrays = [
  Float32Array.from(points), Float32Array.from(rest), Int32Array.from(face), new Int32Array(12),
  BigInt64Array.from(triangles.flat(), BigInt), BigInt64Array.from(triangles, (_, t) => BigInt(3 * (t + 1))),
];
const blocks = arrays.map((array) => Buffer.concat([Buffer.from(BigUint64Array.of(BigInt(array.byteLength)).buffer), Buffer.from(array.buffer)]));
const offset = blocks.map((_, i) => blocks.slice(0, i).reduce((sum, block) => sum + block.length, 0));

const header = `<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<PolyData>
<Piece NumberOfPoints="8" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="12">
<Points><DataArray type="Float32" Name="Points" NumberOfComponents="3" format="appended" offset="${offset[0]}"/></Points>
<PointData><DataArray type="Float32" Name="rest" NumberOfComponents="3" format="appended" offset="${offset[1]}"/></PointData>
<CellData>
<DataArray type="Int32" Name="face" format="appended" offset="${offset[2]}"/>
<DataArray type="Int32" Name="piece" format="appended" offset="${offset[3]}"/>
</CellData>
<Polys>
<DataArray type="Int64" Name="connectivity" format="appended" offset="${offset[4]}"/>
<DataArray type="Int64" Name="offsets" format="appended" offset="${offset[5]}"/>
</Polys>
</Piece>
</PolyData>
<AppendedData encoding="raw">
_`;
writeFileSync(join(data, 'cube.vtp'), Buffer.concat([Buffer.from(header), ...blocks, Buffer.from('\n</AppendedData>\n</VTKFile>\n')]));

const line = (word, numbers) => `${word} ${numbers.join(' ')}\n`;
const vertices = Array.from({ length: 8 }, (_, i) => line('v', points.slice(3 * i, 3 * i + 3).map((c) => +c.toFixed(6))));
writeFileSync(join(data, 'cube.obj'), vertices.join('') + triangles.map((t) => line('f', t.map((v) => v + 1))).join(''));
