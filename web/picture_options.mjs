// SPDX-License-Identifier: Apache-2.0
// The command line of picture.mjs, as plain JavaScript: it must say what is wrong even where nothing is built.

/** @typedef {import('./src/request.ts').View} View */
/**
 * @typedef {object} PictureOptions
 * @property {string[]} surfaces
 * @property {string} out
 * @property {[number, number]} size
 * @property {{eye: number[], target: number[], fov?: number}} [camera]
 * @property {View} [view]
 * @property {{heel: number[], tip: number[]}} [blade]
 * @property {string} [title]
 */

export const usage = 'node picture.mjs SURFACE... --out PNG [--size 1280x800] [--camera ex,ey,ez,tx,ty,tz[,fov]] ' +
  '[--view front|back|left|right|above|below|three_quarter] [--blade hx,hy,hz,tx,ty,tz] [--title TEXT]';

const views = ['front', 'back', 'left', 'right', 'above', 'below', 'three_quarter'];

/**
 * @param {string[]} words
 * @returns {PictureOptions}
 */
export function parseOptions(words) {
  /** @type {Map<string, string>} */
  const given = new Map();
  /** @type {string[]} */
  const surfaces = [];
  for (let i = 0; i < words.length; ++i) {
    const word = words[i];
    if (!word.startsWith('--')) {
      surfaces.push(word);
      continue;
    }
    if (!['--out', '--size', '--camera', '--view', '--blade', '--title'].includes(word)) throw new Error(`${word}: no such option; usage: ${usage}`);
    if (i + 1 >= words.length) throw new Error(`${word}: its value is missing; usage: ${usage}`);
    given.set(word, words[++i]);
  }
  const out = given.get('--out');
  if (surfaces.length === 0) throw new Error(`no surface is given; usage: ${usage}`);
  if (!out) throw new Error(`--out is missing; usage: ${usage}`);
  /** @type {PictureOptions} */
  const options = { surfaces, out, size: readSize(given.get('--size'), surfaces.length) };
  const camera = readNumbers('--camera', given.get('--camera'), [6, 7]);
  if (camera) options.camera = { eye: camera.slice(0, 3), target: camera.slice(3, 6), ...(camera.length > 6 && { fov: camera[6] }) };
  const blade = readNumbers('--blade', given.get('--blade'), [6]);
  for (const [option, ends] of /** @type {const} */ ([['--camera', camera], ['--blade', blade]])) {
    if (ends && [0, 1, 2].every((k) => ends[k] === ends[k + 3])) throw new Error(`${option} ${given.get(option)}: both places are the same; give two different ones`);
  }
  if (blade) options.blade = { heel: blade.slice(0, 3), tip: blade.slice(3) };
  const view = given.get('--view');
  if (view !== undefined && !views.includes(view)) throw new Error(`--view ${view}: no such view; give one of ${views.join(', ')}`);
  if (view !== undefined) options.view = /** @type {View} */ (view);
  const title = given.get('--title');
  if (title !== undefined) options.title = title;
  return options;
}

/**
 * @param {string | undefined} text
 * @param {number} stills
 * @returns {[number, number]}
 */
function readSize(text, stills) {
  if (text === undefined) return stills === 1 ? [1280, 800] : [640 * stills, 560];
  const [, width, height] = /^(\d+)x(\d+)$/.exec(text) ?? [];
  const inRange = (/** @type {string} */ side) => Number(side) >= 64 && Number(side) <= 8192;
  if (!inRange(width) || !inRange(height)) throw new Error(`--size ${text}: give WIDTHxHEIGHT in pixels, 64 to 8192 each, such as 1280x800`);
  return [Number(width), Number(height)];
}

/**
 * @param {string} option
 * @param {string | undefined} text
 * @param {number[]} counts
 * @returns {number[] | undefined}
 */
function readNumbers(option, text, counts) {
  if (text === undefined) return undefined;
  const numbers = text.split(',').map((word) => (word.trim() === '' ? NaN : Number(word)));
  if (!counts.includes(numbers.length) || !numbers.every(Number.isFinite)) {
    throw new Error(`${option} ${text}: give ${counts.join(' or ')} numbers with commas between them, in metres`);
  }
  return numbers;
}
