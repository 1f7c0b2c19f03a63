// SPDX-License-Identifier: Apache-2.0
// The simulator in a real browser, with a real mouse: simulator_page.mjs RESECT SCENES OUT. Leaves pictures in OUT.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { chromium } from 'playwright-core';
import { chromiumFlags } from '../chromium_flags.mjs';

const [program, scenes, out] = process.argv.slice(2);
mkdirSync(out, { recursive: true });
const patience = 15_000;

/** @param {number} port */
function startEngine(port) {
  const engine = spawn(program, ['serve', join(scenes, 'liver.json'), '--port', String(port), '--out', out, '--threads', '1'], { stdio: ['ignore', 'pipe', 'inherit'] });
  return new Promise((resolve, reject) => {
    engine.on('exit', () => reject(new Error('the engine has ended')));
    engine.stdout.on('data', (text) => {
      const said = /http:\/\/localhost:(\d+)\//.exec(String(text));
      if (said) resolve({ engine, port: Number(said[1]) });
    });
  });
}

/** Runs in the page. @type {(page: import('playwright-core').Page, read: string) => Promise<any>} */
const ask = (page, read) => page.evaluate(`(async () => (${read}))()`);

/** Asked from outside: the page's own policy forbids it to evaluate texts. @param {import('playwright-core').Page} page @param {string} condition */
async function until(page, condition) {
  const end = Date.now() + patience;
  while (!(await ask(page, condition))) {
    if (Date.now() > end) assert.fail(`never came true: ${condition}; ${await ask(page, 'JSON.stringify([resect.status, resect.scene?.name])')}`);
    await page.waitForTimeout(50);
  }
}

/** @param {import('playwright-core').Page} page @param {number[]} from @param {number[]} to */
async function drag(page, from, to, steps = 12) {
  await page.mouse.move(from[0], from[1]);
  await page.mouse.down();
  for (let i = 1; i <= steps; ++i) {
    await page.mouse.move(from[0] + ((to[0] - from[0]) * i) / steps, from[1] + ((to[1] - from[1]) * i) / steps);
    await page.waitForTimeout(40);
  }
  await page.mouse.up();
}

/** @param {number[]} values */
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

/** @param {import('playwright-core').Page} page */
async function cutGraspAndUndo(page) {
  await page.click('#hint-close');
  await page.keyboard.press('Space');
  await until(page, 'resect.status.paused');
  const before = await ask(page, 'resect.hash()');
  await drag(page, [540, 240], [620, 420]);
  await until(page, 'resect.status.strokes === 1 && resect.status.cut_elements > 20');
  assert.notEqual(await ask(page, 'resect.hash()'), before, 'a drag cuts');
  await page.keyboard.press('Control+z');
  await until(page, 'resect.status.strokes === 0');
  assert.equal(await ask(page, 'resect.hash()'), before, 'undo restores the hash');

  await page.keyboard.press('Space');
  await drag(page, [540, 240], [620, 420]);
  await page.waitForTimeout(500);
  await page.screenshot({ path: join(out, 'page_cut.png') });
  await page.keyboard.press('3');
  await page.keyboard.press('p');
  const lip = [610, 330];
  const hit = await ask(page, `resect.pick(${lip})`);
  assert.ok(hit, 'there is tissue beside the cut');
  const at = await ask(page, `resect.vertex(${hit.vertex})`);
  await drag(page, lip, [lip[0] + 70, lip[1] - 30]);
  await page.waitForTimeout(700);
  const now = await ask(page, `resect.vertex(${hit.vertex})`);
  assert.ok(Math.hypot(now[0] - at[0], now[1] - at[1], now[2] - at[2]) > 0.004, 'the lip is pulled open');
  await page.screenshot({ path: join(out, 'page_grasp.png') });
  for (const view of ['Stress', 'Elements', 'Tissue']) {
    await page.click(`#views button:text-is("${view}")`);
    await page.waitForTimeout(600);
    await page.screenshot({ path: join(out, `page_${view.toLowerCase()}.png`) });
  }
}

/** @param {import('playwright-core').Page} page */
async function saveAndReplay(page) {
  await page.keyboard.press('d');
  const saving = page.waitForEvent('download');
  await page.click('dialog button[value="record"]');
  const name = (await saving).suggestedFilename();
  assert.match(name, /^record_liver_.*\.json$/);
  const replayed = spawnSync(program, ['replay', join(out, name), '--check-hash'], { encoding: 'utf8' });
  assert.equal(replayed.status, 0, replayed.stderr);
  assert.match(replayed.stdout, /as recorded/);
  assert.ok(JSON.parse(readFileSync(join(out, name), 'utf8')).commands.length > 20);
}

/** @param {import('playwright-core').Page} page */
async function changeScenes(page) {
  await page.click('[data-scene=kidney]');
  await until(page, 'resect.ready && resect.scene.name === "kidney"');
  await page.waitForTimeout(800);
  await page.screenshot({ path: join(out, 'page_kidney.png') });
  const mesh = join(out, 'dropped.msh'), broken = join(out, 'broken.msh');
  assert.equal(spawnSync(program, ['mesh', 'block', '-o', mesh, '--cells', '6', '6', '6']).status, 0);
  await page.setInputFiles('#file', mesh);
  await until(page, 'resect.ready && resect.scene.title === "dropped.msh" && resect.scene.elements === 1296');
  writeFileSync(broken, '$MeshFormat\nno mesh\n');
  await page.setInputFiles('#file', broken);
  await page.waitForSelector('.toast:has-text("broken.msh")', { timeout: patience });
  assert.equal(await ask(page, 'resect.scene.title'), 'dropped.msh', 'a broken file changes nothing');
}

/** From sending a pose to having the frame that shows it. @param {import('playwright-core').Page} page @param {string} address */
async function measure(page, address) {
  await page.goto(`${address}?pixel`);
  await until(page, 'resect.ready && resect.driving');
  await ask(page, `new Promise((done) => {
    let i = 0;
    const move = () => {
      resect.send({ command: { move_blade: { blade: 0, heel: [1, 1, 1 + 0.001 * i], tip: [1, 2, 1] } } });
      if (++i < 120) setTimeout(move, 17); else setTimeout(done, 300);
    };
    move();
  })`);
  const latency = await ask(page, 'resect.latency'), script = await ask(page, 'resect.scriptMs');
  console.log(`latency, pose to frame: median ${median(latency).toFixed(1)} ms of ${latency.length}; script ${script.toFixed(2)} ms a frame at ${await ask(page, 'resect.frame.triangles')} triangles`);
  assert.ok(latency.length > 100);
}

const first = await startEngine(0);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: chromiumFlags });
let { engine } = first;
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, acceptDownloads: true });
  /** @type {string[]} */
  const complaints = [];
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.message));
  const address = `http://localhost:${first.port}/`;
  await page.goto(`${address}?quality=low`);
  await until(page, 'window.resect?.ready && resect.driving');
  await page.screenshot({ path: join(out, 'page_start.png') });
  await cutGraspAndUndo(page);
  await saveAndReplay(page);
  await changeScenes(page);
  assert.deepEqual(complaints, [], 'no error in the console');

  engine.removeAllListeners('exit');
  engine.kill('SIGKILL');
  await page.waitForSelector('#curtain:not([hidden])', { timeout: patience });
  await page.screenshot({ path: join(out, 'page_engine_gone.png') });
  ({ engine } = await startEngine(first.port));
  await until(page, 'document.getElementById("curtain").hidden && resect.ready && resect.scene.name === "liver"');
  await measure(page, address);
  console.log('the page works');
} finally {
  engine.removeAllListeners('exit');
  engine.kill();
  await browser.close();
}
