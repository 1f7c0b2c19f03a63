// SPDX-License-Identifier: Apache-2.0
import { drawPicture } from './picture.ts';
import type { PictureRequest } from './request.ts';

/** Answers with the fault instead of throwing, so that the caller prints one line and no stack. */
function draw(request: PictureRequest): string | undefined {
  try {
    drawPicture(request);
    return undefined;
  } catch (error) {
    return (error as Error).message;
  }
}

Object.assign(window, { drawPicture: draw });
