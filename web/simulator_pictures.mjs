// SPDX-License-Identifier: Apache-2.0
// Draws the pictures of the simulator: simulator_pictures.mjs RESECT SCENES OUT. Minutes, where a processor draws.
import { join } from 'node:path';
import { ask, drag, openBrowser, startEngine, stopEngine, until } from './drive.mjs';

const [program, scenes, out] = process.argv.slice(2);
/** A picture may take a second where a processor draws. */
const settled = 3000;

const { engine, port } = await startEngine(program, [join(scenes, 'liver.json'), '--port', '0']);
const browser = await openBrowser();
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  /** @param {string} name */
  const shoot = async (name) => {
    await page.waitForTimeout(settled);
    await page.screenshot({ path: join(out, `${name}.png`) });
  };
  await page.goto(`http://localhost:${port}/?quality=high`);
  await until(page, 'window.resect?.ready');
  await page.click('#hint-close');
  await ask(page, 'resect.send({ command: { set_material: { region: 0, young: 8000, poisson: 0.35, density: 1000 } } })');
  await page.waitForTimeout(settled);

  await drag(page, [540, 200], [640, 440], 14, 200);
  await shoot('simulator_knife');
  await page.mouse.up();
  await page.keyboard.press('3');
  await page.keyboard.press('p');
  await drag(page, [625, 330], [700, 300], 8, 200);
  await page.waitForTimeout(settled);
  await page.mouse.up();
  await shoot('simulator_cut');
  await page.click('#views button:text-is("Stress")');
  await shoot('simulator_stress');

  await page.click('[data-scene=strip]');
  await until(page, 'resect.ready && resect.scene.name === "strip"');
  await page.click('#views button:text-is("Tissue")');
  await page.keyboard.press('1');
  await page.waitForTimeout(settled);
  await drag(page, [500, 350], [690, 380], 10, 200);
  await page.waitForTimeout(settled);
  await page.mouse.up();
  await page.mouse.move(600, 640);
  await shoot('simulator_strip');
} finally {
  stopEngine(engine);
  await browser.close();
}
