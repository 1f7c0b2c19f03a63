// SPDX-License-Identifier: Apache-2.0
// Draws surfaces as one PNG by the picture page in headless Chromium. Every fault is one line and exit status 2.
import { existsSync, readFileSync } from 'node:fs';
import { writeFile } from 'node:fs/promises';
import { basename, dirname, extname, join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { chromiumFlags } from './chromium_flags.mjs';
import { parseOptions } from './picture_options.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const page = join(here, 'dist/picture.html');

/** A busy machine may take a minute where an idle one takes a second. */
const patience = 120_000;

/** @param {string} path */
function readSurfaceFile(path) {
  try {
    return readFileSync(path);
  } catch (error) {
    const code = /** @type {NodeJS.ErrnoException} */ (error).code;
    throw new Error(code === 'ENOENT' ? `${path}: no such file; give a .vtp or .obj surface` : `${path}: cannot be read (${code})`);
  }
}

async function loadPlaywright() {
  try {
    return (await import('playwright-core')).chromium;
  } catch {
    throw new Error(`${join(here, 'node_modules')}: playwright-core is missing; run 'npm ci' in ${here}`);
  }
}

async function openBrowser() {
  const chromium = await loadPlaywright();
  if (!existsSync(page)) throw new Error(`${page}: the picture page is not built; run 'npm ci && npm run build' in ${here}`);
  const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';
  if (!existsSync(executablePath)) throw new Error(`${executablePath}: no Chromium; install it (apt install chromium) or name it in CHROMIUM`);
  try {
    return await chromium.launch({ executablePath, args: chromiumFlags, timeout: patience });
  } catch (error) {
    throw new Error(`${executablePath}: Chromium does not start (${firstLine(error)}); run it by hand to see why`);
  }
}

/** @param {unknown} error */
function firstLine(error) {
  return String(error instanceof Error ? error.message : error).split('\n')[0];
}

/** @param {import('./picture_options.mjs').PictureOptions} options */
async function draw({ surfaces, out, ...look }) {
  const request = {
    ...look,
    surfaces: surfaces.map((path) => ({
      name: path,
      caption: basename(path, extname(path)),
      base64: readSurfaceFile(path).toString('base64'),
    })),
  };
  const browser = await openBrowser();
  try {
    const [width, height] = look.size;
    const tab = await browser.newPage({ viewport: { width, height } });
    await tab.goto(pathToFileURL(page).href, { timeout: patience });
    const fault = await tab.evaluate((asked) => /** @type {any} */ (window).drawPicture(asked), request);
    if (fault) throw new Error(fault);
    await writeFile(out, await tab.screenshot({ type: 'png', timeout: patience })).catch((error) => {
      throw new Error(`${out}: cannot be written (${error.code}); give a path in a folder that exists`);
    });
  } finally {
    await browser.close();
  }
}

try {
  await draw(parseOptions(process.argv.slice(2)));
} catch (error) {
  process.stderr.write(`picture: ${firstLine(error)}\n`);
  process.exitCode = 2;
}
