// SPDX-License-Identifier: Apache-2.0

/** Halton numbers: every prefix of the sequence is spread evenly over 0 to 1. */
export function radicalInverse(i: number, base: number): number {
  let result = 0;
  for (let part = 1 / base; i > 0; part /= base, i = Math.floor(i / base)) result += part * (i % base);
  return result;
}
