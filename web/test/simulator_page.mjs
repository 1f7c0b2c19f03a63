// SPDX-License-Identifier: Apache-2.0
// The simulator in a real browser, with a real mouse: simulator_page.mjs RESECT SCENES OUT. Leaves pictures in OUT.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { ask, drag, openBrowser, startEngine, stopEngine, until } from '../drive.mjs';

const [program, scenes, out] = process.argv.slice(2);
mkdirSync(out, { recursive: true });
const patience = 60_000;
/** @param {number} port */
const start = (port) => startEngine(program, [join(scenes, 'liver.json'), '--port', String(port), '--out', out, '--threads', '1']);

/** @param {number[]} values */
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

/** @param {import('playwright-core').Page} page @param {number[]} from @param {number[]} to */
async function stroke(page, from, to) {
  await drag(page, from, to);
  await page.mouse.up();
}

/** @param {import('playwright-core').Page} page */
async function cutGraspAndUndo(page) {
  await page.click('#hint-close');
  await page.keyboard.press('Space');
  await until(page, 'resect.status.paused');
  const before = await ask(page, 'resect.hash()');
  await stroke(page, [540, 240], [620, 420]);
  await until(page, 'resect.status.strokes === 1 && resect.status.cut_elements > 20');
  assert.notEqual(await ask(page, 'resect.hash()'), before, 'a drag cuts');
  await page.keyboard.press('Control+z');
  await until(page, 'resect.status.strokes === 0');
  assert.equal(await ask(page, 'resect.hash()'), before, 'undo restores the hash');

  await page.keyboard.press('Space');
  await stroke(page, [540, 240], [620, 420]);
  await page.waitForTimeout(500);
  await page.screenshot({ path: join(out, 'page_cut.png') });
  await page.keyboard.press('3');
  await page.keyboard.press('p');
  const lip = [610, 330];
  const hit = await ask(page, `resect.pick(${lip})`);
  assert.ok(hit, 'there is tissue beside the cut');
  const at = await ask(page, `resect.vertex(${hit.vertex})`);
  await stroke(page, lip, [lip[0] + 70, lip[1] - 30]);
  await page.waitForTimeout(700);
  const now = await ask(page, `resect.vertex(${hit.vertex})`);
  assert.ok(Math.hypot(now[0] - at[0], now[1] - at[1], now[2] - at[2]) > 0.004, 'the lip is pulled open');
  await page.screenshot({ path: join(out, 'page_grasp.png') });
  for (const view of ['Stress', 'Elements', 'Tissue']) {
    await page.click(`#views button:text-is("${view}")`);
    await page.waitForTimeout(600);
    await page.screenshot({ path: join(out, `page_${view.toLowerCase()}.png`) });
  }
  // Keys work on after a box was ticked.
  await page.getByText('Clip', { exact: true }).click();
  await page.getByText('Clip', { exact: true }).click();
  await page.keyboard.press('s');
  await until(page, 'resect.status.speed < 1');
  await page.keyboard.press('s');
  await until(page, 'resect.status.speed === 1');
}

/** With a tool in hand: the right button turns, the middle one moves. @param {import('playwright-core').Page} page */
async function lookAround(page) {
  const was = await ask(page, 'resect.heading');
  for (const button of /** @type {const} */ (['right', 'middle'])) {
    await page.mouse.move(560, 420);
    await page.mouse.down({ button });
    await page.mouse.move(500, 430);
    await page.mouse.move(460, 440);
    await page.mouse.up({ button });
    const now = await ask(page, 'resect.heading');
    const turned = Math.hypot(...now.map((x, i) => x - was[i]));
    if (button === 'right') {
      assert.ok(turned > 0.1, 'the right button turns the view');
      was.splice(0, 3, ...now);
    } else assert.ok(turned < 1e-6, 'the middle button moves it only');
  }
  await page.keyboard.press('f');
}

/** Two points part the body, which stands still; the probe then tells of a piece. @param {import('playwright-core').Page} page */
async function partAndProbe(page) {
  await page.keyboard.press('Space');
  await until(page, 'resect.status.paused');
  await page.keyboard.press('2');
  await page.waitForTimeout(500); // the view was just framed
  const ends = await ask(page, '[[0.03, 0.14, 0], [0.03, -0.14, 0]].map(resect.screenOf)');
  await stroke(page, ends[0], ends[1]);
  await page.keyboard.press('4'); // the blade goes on
  await until(page, 'resect.status.pieces[1]?.volume > 1e-4');
  await page.mouse.move(560, 400);
  await page.waitForSelector('#readout:not([hidden])', { timeout: patience });
  await until(page, `/von mises stress [\\d.]+ kPa/i.test(document.querySelector('#readout').innerText)`);
  assert.match(await page.innerText('#readout'), /Moved by [\d.]+ mm[^]*Piece \d+: [\d.]+ cm³, \d+ g/);
  await page.screenshot({ path: join(out, 'page_probe.png') });
  await page.keyboard.press('Control+z');
  await until(page, 'resect.status.piece_count === 1');
  await page.keyboard.press('Space');
}

/** @param {import('playwright-core').Page} page */
async function checkNames(page) {
  const nameless = await ask(page, `[...document.querySelectorAll('button, input, select, summary, canvas, [role]')]
    .filter((one) => !(one.ariaLabel || one.getAttribute('aria-labelledby') || one.title || one.innerText || one.labels?.[0]?.innerText || one.textContent.trim()))
    .filter((one) => !one.matches('.uplot *, [role=status]'))
    .map((one) => one.outerHTML.slice(0, 80))`);
  assert.deepEqual(nameless, [], 'every control has a name');
}

/** @param {import('playwright-core').Page} page */
async function saveAll(page) {
  const kept = async (/** @type {() => Promise<void>} */ act) => {
    const saving = page.waitForEvent('download', { timeout: patience });
    await act();
    const file = join(out, (await saving).suggestedFilename());
    await (await saving).saveAs(file);
    return readFileSync(file);
  };
  assert.equal((await kept(() => page.keyboard.press('i'))).subarray(1, 4).toString(), 'PNG');
  await page.keyboard.press('o');
  await page.waitForTimeout(4000); // a body at rest is filmed, too; processors encode slowly
  assert.ok((await kept(() => page.keyboard.press('o'))).length > 1000, 'there is a film');
  for (const [what, begin] of [['surface.obj', /^#|^o |^v /], ['mesh.vtu', /^<\?xml|^<VTKFile/]]) {
    const text = await kept(async () => {
      await page.keyboard.press('d');
      await page.click(`dialog button[value="${what}"]`);
    });
    assert.match(text.subarray(0, 200).toString(), /** @type {RegExp} */ (begin));
  }
}

/** A pen cuts as a mouse does; one finger cuts, two turn and zoom. @param {import('playwright-core').Browser} browser @param {string} address */
async function usePenAndFingers(browser, address) {
  const context = await browser.newContext({ viewport: { width: 1024, height: 768 }, hasTouch: true });
  const page = await context.newPage();
  await page.goto(`${address}?quality=low`);
  await until(page, 'window.resect?.ready && resect.driving');
  await page.tap('#hint-close');
  const devtools = await context.newCDPSession(page);
  const steps = 12;
  /** @param {'mousePressed' | 'mouseMoved' | 'mouseReleased'} type @param {number} i */
  const pen = (type, i) => devtools.send('Input.dispatchMouseEvent', { type, x: 420 + 5 * i, y: 260 + 12 * i, button: 'left', buttons: 1, clickCount: 1, pointerType: 'pen' });
  await pen('mousePressed', 0);
  for (let i = 1; i <= steps; ++i) {
    await pen('mouseMoved', i);
    await page.waitForTimeout(40);
  }
  await pen('mouseReleased', steps);
  await until(page, 'resect.status.strokes === 1 && resect.status.cut_elements > 20');

  /** @param {'touchStart' | 'touchMove' | 'touchEnd'} type @param {number[][]} points */
  const touch = async (type, ...points) => {
    await devtools.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    await page.waitForTimeout(40);
  };
  await touch('touchStart', [380, 300]);
  for (let i = 1; i <= steps; ++i) await touch('touchMove', [380 + 3 * i, 300 + 10 * i]);
  await touch('touchEnd');
  await until(page, 'resect.status.strokes === 2');
  const [cut, away] = await ask(page, '[resect.status.cut_elements, resect.distance]');
  await touch('touchStart', [400, 350]);
  await touch('touchStart', [400, 350], [480, 350]);
  for (let i = 1; i <= steps; ++i) await touch('touchMove', [400 - 8 * i, 350], [480 + 8 * i, 350]);
  await touch('touchEnd');
  await page.waitForTimeout(500);
  assert.ok((await ask(page, 'resect.distance')) < 0.8 * away, 'fingers that part come nearer');
  assert.ok((await ask(page, 'resect.status.cut_elements')) < cut + 20, 'a pinch is no cut');
  await page.screenshot({ path: join(out, 'page_tablet.png') });
  await ask(page, 'resect.send({ reset: true })');
  await until(page, 'resect.status.strokes === 0');
  await context.close();
}

/** The sliders show what the tissue is, whoever changed it. @param {import('playwright-core').Page} page */
async function changeMaterial(page) {
  for (const young of [8000, 5000]) {
    await ask(page, `resect.send({ command: { set_material: { region: 0, young: ${young}, poisson: 0.35, density: 1000 } } })`);
    await until(page, `document.querySelector('output[for=slider-young-s-modulus]').value === '${young / 1000}.00 kPa'`);
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
  const latency = await ask(page, 'resect.latency');
  console.log(`latency, pose to frame: median ${median(latency).toFixed(1)} ms of ${latency.length}`);
  assert.ok(latency.length > 100);
}

/** What the page computes for a frame of a body of 25,000 triangles that moves. @param {import('playwright-core').Page} page */
async function measureScript(page) {
  const scene = JSON.parse(readFileSync(join(scenes, 'liver.json'), 'utf8'));
  scene.tissue.mesh.liver = { elements: 15500, refine: 1 };
  const path = join(out, 'large_liver.json');
  writeFileSync(path, JSON.stringify(scene));
  const large = await startEngine(program, [path, '--port', '0', '--out', out, '--threads', '1']);
  try {
    await page.goto(`http://localhost:${large.port}/?pixel`);
    await until(page, 'window.resect?.ready && resect.scripts.length >= 20');
    await ask(page, 'resect.scripts.splice(0)'); // shaders were compiled
    await until(page, 'resect.scripts.length >= 100');
    const script = await ask(page, 'resect.scripts');
    console.log(`script: median ${median(script).toFixed(2)} ms a frame at ${await ask(page, 'resect.frame.triangles')} triangles`);
    assert.ok(median(script) > 0);
  } finally {
    stopEngine(large.engine);
  }
}

const first = await start(0);
const browser = await openBrowser();
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
  await lookAround(page);
  await partAndProbe(page);
  await checkNames(page);
  await changeMaterial(page);
  await saveAndReplay(page);
  await saveAll(page);
  await changeScenes(page);
  assert.deepEqual(complaints, [], 'no error in the console');

  stopEngine(engine);
  await page.waitForSelector('#curtain:not([hidden])', { timeout: patience });
  await page.screenshot({ path: join(out, 'page_engine_gone.png') });
  ({ engine } = await start(first.port));
  await until(page, 'document.getElementById("curtain").hidden && resect.ready && resect.scene.name === "liver"');
  await page.goto('about:blank'); // another drives
  await usePenAndFingers(browser, address);
  await measure(page, address);
  await measureScript(page);
  console.log('the page works');
} finally {
  stopEngine(engine);
  await browser.close();
}
