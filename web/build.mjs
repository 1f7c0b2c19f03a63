// SPDX-License-Identifier: Apache-2.0
// Bundles the picture and the report page into one HTML file each and the simulator into a folder, or, with --tests, each test into one file
// that Node can run.
import { cpSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, 'dist');
mkdirSync(dist, { recursive: true });

/** One HTML file with its script, and its style if it has one, inside. @param {string} script @param {string} page @param {string} out */
async function buildPage(script, page, out) {
  const result = await build({
    entryPoints: [join(here, script)],
    bundle: true, minify: true, format: 'iife', target: 'es2022', legalComments: 'inline', write: false, outdir: dist,
  });
  /** @param {string} ending */
  const text = (ending) => result.outputFiles.find((file) => file.path.endsWith(ending))?.text ?? '';
  // The script sits inside the page, where these letters would end it.
  const inlined = text('.js').replaceAll('</script', '<\\/script');
  const html = readFileSync(join(here, page), 'utf8');
  writeFileSync(join(dist, out), html.replace('/* style */', () => text('.css')).replace('/* script */', () => inlined));
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
else await Promise.all([
  buildPage('src/picture_page.ts', 'src/picture.html', 'picture.html'),
  buildPage('src/report/report.ts', 'src/report/report.html', 'report.html'),
  buildSimulator(),
]);
