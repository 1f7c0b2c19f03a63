// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { align } from '../src/report/plot.ts';

test('series with places of their own share one list of places, with holes', () => {
  const one = { name: 'one', x: [3, 1], y: [30, 10], points: false };
  const other = { name: 'other', x: [2, 3], y: [0.2, 0.3], points: true };
  assert.deepEqual(align([one, other]), [[1, 2, 3], [10, null, 30], [null, 0.2, 0.3]]);
  assert.deepEqual(align([]), [[]]);
});
