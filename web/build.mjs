// SPDX-License-Identifier: Apache-2.0
// Bundles the picture page into one HTML file and the simulator into a folder, or, with --tests, each test into one file
// that Node can run.
import { cpSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, 'dist');
mkdirSync(dist, { recursive: true });

async function buildPicture() {
  const result = await build({
    entryPoints: [join(here, 'src/picture_page.ts')],
    bundle: true, minify: true, format: 'iife', target: 'es2022', legalComments: 'inline', write: false,
  });
  // The script sits inside the page, where these letters would end it.
  const script = result.outputFiles[0].text.replaceAll('</script', '<\\/script');
  const page = readFileSync(join(here, 'src/picture.html'), 'utf8');
  writeFileSync(join(dist, 'picture.html'), page.replace('/* script */', () => script));
}

async function buildSimulator() {
  const source = join(here, 'src/simulator'), out = join(dist, 'simulator');
  rmSync(out, { recursive: true, force: true });
  const thumbnails = join(here, 'thumbnails');
  await build({
    define: { SCENES_WITH_PICTURES: JSON.stringify(readdirSync(thumbnails).map((name) => basename(name, '.png'))) },
    entryPoints: [join(source, 'simulator.ts'), join(source, 'simulator.css')],
    bundle: true, minify: true, format: 'iife', target: 'es2022', legalComments: 'inline', outdir: out, logLevel: 'warning',
  });
  cpSync(join(source, 'simulator.html'), join(out, 'index.html'));
  cpSync(thumbnails, join(out, 'thumbnails'), { recursive: true });
}

async function buildTests() {
  const tests = join(here, 'test');
  rmSync(join(dist, 'test'), { recursive: true, force: true });
  await build({
    entryPoints: readdirSync(tests).filter((name) => name.endsWith('.test.ts')).map((name) => join(tests, name)),
    bundle: true, platform: 'node', format: 'esm', target: 'node18', outdir: join(dist, 'test'), outExtension: { '.js': '.mjs' },
  });
}

if (process.argv.includes('--tests')) await buildTests();
else await Promise.all([buildPicture(), buildSimulator()]);
