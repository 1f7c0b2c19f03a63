// SPDX-License-Identifier: Apache-2.0
// Films the simulator: simulator_film.mjs RESECT SCENES FOLDER. Leaves frame_0000.png, ... in FOLDER. The
// engine runs in slow motion, so that a processor has the time to draw; played at `framesPerSecond`
// the film is at the speed of life.
import { join } from 'node:path';
import { ask, openBrowser, startEngine, stopEngine, until } from './drive.mjs';

const [program, scenes, folder] = process.argv.slice(2);
const framesPerSecond = 12, slow = 0.05, movesPerFrame = 4;
const arrow = '<svg viewBox="0 0 20 20" width="26"><path d="M3 1l13 10-6 1 4 6-3 1-3-6-5 4z" fill="#fff" stroke="#123"/></svg>';

const { engine, port } = await startEngine(program, [join(scenes, 'liver.json'), '--port', '0']);
const browser = await openBrowser();
const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, deviceScaleFactor: 0.625 });
const page = await context.newPage();
let frame = 0, due = 0; // s of the simulation, which undo takes back
let at = [900, 640];

/** @param {number[]} to */
async function point(to) {
  at = to;
  await page.mouse.move(to[0], to[1]);
  await ask(page, `Object.assign(document.querySelector('#arrow').style, { left: '${to[0]}px', top: '${to[1]}px' })`);
}

/** Frames in which the pointer goes to a place, or rests. @param {number} seconds */
async function roll(seconds, to = at) {
  const from = at, frames = Math.round(seconds * framesPerSecond);
  const ease = (/** @type {number} */ t) => t * t * (3 - 2 * t);
  for (let i = 1; i <= frames; ++i) {
    due += 1 / framesPerSecond;
    for (let move = 1; move <= movesPerFrame && to !== from; ++move) {
      const t = ease((i - 1 + move / movesPerFrame) / frames);
      await point([from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])]);
      await until(page, `resect.status.time >= ${due - (1 - move / movesPerFrame) / framesPerSecond}`);
    }
    await until(page, `resect.status.time >= ${due}`);
    await ask(page, 'resect.send({ pause: true })');
    await page.screenshot({ path: join(folder, `frame_${String(frame++).padStart(4, '0')}.png`) });
    await ask(page, 'resect.send({ pause: false })');
  }
}

async function undo() {
  const before = await ask(page, 'resect.status.time');
  await page.keyboard.press('Control+z');
  await until(page, `resect.status.time < ${before}`);
  due = await ask(page, 'resect.status.time');
}

/** A click on a panel, after which the pointer is where it was. @param {string} what */
async function click(what) {
  await page.click(what);
  await point(at);
}

const view = (/** @type {string} */ name) => click(`#views button:text-is("${name}")`);

try {
  await page.goto(`http://localhost:${port}/?quality=high`);
  await until(page, 'window.resect?.ready');
  await page.click('#hint-close');
  await ask(page, `document.body.insertAdjacentHTML('beforeend', '<div id="arrow" style="position:fixed;pointer-events:none;z-index:9">${arrow}</div>')`);
  await ask(page, `document.querySelector('#state').style.visibility = 'hidden'`); // it would tell of slow motion
  await page.click('#figures summary');
  await ask(page, 'resect.send({ command: { set_material: { region: 0, young: 8000, poisson: 0.35, density: 1000 } } })');
  await page.waitForTimeout(4000);
  await ask(page, `resect.send({ speed: ${slow} })`);
  due = await ask(page, 'resect.status.time');

  await roll(1, [540, 200]);
  await page.mouse.down();
  await roll(2.5, [640, 440]);
  await page.mouse.up();
  await roll(0.7);
  await page.keyboard.press('3');
  await page.keyboard.press('p');
  await roll(0.8, [625, 330]);
  await page.mouse.down();
  await roll(1.5, [715, 292]);
  await page.mouse.up();
  await roll(0.8, [660, 560]);
  await view('Stress');
  await roll(1.5);
  await view('Elements');
  await roll(1.2);
  await view('Tissue');
  await page.mouse.down({ button: 'right' });
  await roll(1.4, [740, 570]);
  await roll(1.4, [660, 560]);
  await page.mouse.up({ button: 'right' });
  await page.keyboard.press('2');
  await roll(0.7, [890, 200]);
  await page.mouse.down();
  await roll(0.4, [760, 670]);
  await page.mouse.up();
  await roll(0.8);
  await roll(0.8, [860, 690]);
  await view('Pieces');
  await roll(1.4);
  await view('Tissue');
  await undo();
  await roll(1.2);
  await undo();
  await roll(1.9);
} finally {
  stopEngine(engine);
  await browser.close();
}
