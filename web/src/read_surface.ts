// SPDX-License-Identifier: Apache-2.0
import { readObj } from './read_obj.ts';
import { readVtp } from './read_vtp.ts';
import type { Surface } from './surface.ts';

/** Picks the reader by the file's ending; the name is only read for that. */
export function readSurface(name: string, bytes: Uint8Array): Surface {
  const ending = name.slice(name.lastIndexOf('.') + 1).toLowerCase();
  if (ending === 'vtp') return readVtp(bytes);
  if (ending === 'obj') return readObj(bytes);
  throw new Error('its format is not known; give a .vtp or .obj surface');
}
