// SPDX-License-Identifier: Apache-2.0
// Drives the simulator as a person does, for its tests and its pictures.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { chromium } from 'playwright-core';
import { chromiumFlags } from './chromium_flags.mjs';

const patience = 60_000;

/** `resect serve` with what follows; answers the process and its port. @param {string} program @param {string[]} rest */
export function startEngine(program, rest) {
  const engine = spawn(program, ['serve', ...rest], { stdio: ['ignore', 'pipe', 'inherit'] });
  return new Promise((resolve, reject) => {
    engine.on('exit', () => reject(new Error('the engine has ended')));
    engine.stdout.on('data', (text) => {
      const said = /http:\/\/localhost:(\d+)\//.exec(String(text));
      if (said) resolve({ engine, port: Number(said[1]) });
    });
  });
}

/** @param {import('node:child_process').ChildProcess} engine */
export function stopEngine(engine) {
  engine.removeAllListeners('exit');
  engine.kill('SIGKILL');
}

export function openBrowser() {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: chromiumFlags });
}

/** Runs in the page. @type {(page: import('playwright-core').Page, read: string) => Promise<any>} */
export const ask = (page, read) => page.evaluate(`(async () => (${read}))()`);

/** Asked from outside: the page's own policy forbids it to evaluate texts. @param {import('playwright-core').Page} page @param {string} condition */
export async function until(page, condition) {
  const end = Date.now() + patience;
  while (!(await ask(page, condition))) {
    if (Date.now() > end) assert.fail(`never came true: ${condition}; ${await ask(page, 'JSON.stringify(window.resect?.status)')}`);
    await page.waitForTimeout(50);
  }
}

/** @param {import('playwright-core').Page} page @param {number[]} from @param {number[]} to */
export async function drag(page, from, to, steps = 12, pause = 40) {
  await page.mouse.move(from[0], from[1]);
  await page.mouse.down();
  for (let i = 1; i <= steps; ++i) {
    await page.mouse.move(from[0] + ((to[0] - from[0]) * i) / steps, from[1] + ((to[1] - from[1]) * i) / steps);
    await page.waitForTimeout(pause);
  }
}
