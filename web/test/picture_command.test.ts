// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { test } from 'node:test';
import { parseOptions } from '../picture_options.mjs';

/** Runs the command and wants one line on stderr, nothing else, and status 2. */
function fault(words: string[], environment: Record<string, string> = {}): string {
  const run = spawnSync(process.execPath, ['picture.mjs', ...words], { encoding: 'utf8', env: { ...process.env, ...environment } });
  assert.equal(run.status, 2, run.stderr);
  assert.equal(run.stdout, '');
  assert.match(run.stderr, /^picture: [^\n]+\n$/);
  return run.stderr;
}

test('options become numbers, and a strip is wider than one still', () => {
  const one = parseOptions(['a.vtp', '--out', 'a.png', '--camera', '1,2,3,0,0,0,40', '--blade', '0,0,1,0,0,0', '--title', 'T']);
  assert.deepEqual(one.size, [1280, 800]);
  assert.deepEqual(one.camera, { eye: [1, 2, 3], target: [0, 0, 0], fov: 40 });
  assert.deepEqual(one.blade, { heel: [0, 0, 1], tip: [0, 0, 0] });
  assert.deepEqual(parseOptions(['a.vtp', 'b.vtp', '--out', 'a.png']).size, [1280, 560]);
});

test('wrong command lines are one line and status 2', () => {
  assert.match(fault([]), /no surface is given; usage/);
  assert.match(fault(['a.obj']), /--out is missing/);
  assert.match(fault(['a.obj', '--out']), /--out: its value is missing/);
  assert.match(fault(['a.obj', '--colour', 'red']), /--colour: no such option/);
  assert.match(fault(['a.obj', '--out', 'a.png', '--size', '10']), /such as 1280x800/);
  assert.match(fault(['a.obj', '--out', 'a.png', '--view', 'top']), /front, back, left/);
  assert.match(fault(['a.obj', '--out', 'a.png', '--blade', '1,2,x,4,5,6']), /--blade 1,2,x,4,5,6: give 6 numbers/);
  assert.match(fault(['a.obj', '--out', 'a.png', '--blade', '1,2,3,1,2,3']), /--blade 1,2,3,1,2,3: both places are the same/);
});

test('a missing surface and a missing Chromium are named', () => {
  assert.match(fault(['nowhere.vtp', '--out', 'a.png']), /nowhere\.vtp: no such file/);
  assert.match(fault(['test/data/cube.obj', '--out', 'a.png'], { CHROMIUM: '/nowhere/chromium' }), /\/nowhere\/chromium: no Chromium|not built/);
});
