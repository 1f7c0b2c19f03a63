// SPDX-License-Identifier: Apache-2.0

export type View = 'front' | 'back' | 'left' | 'right' | 'above' | 'below' | 'three_quarter';

/** What the page is asked to draw; plain JSON, so that a report can hold it beside the page. */
export interface PictureRequest {
  surfaces: { name: string; caption: string; base64: string }[];
  /** Width and height of the whole picture in pixels. */
  size: [number, number];
  view?: View;
  /** Eye and target in metres, and the vertical field of view in degrees; the view is not used then. */
  camera?: { eye: number[]; target: number[]; fov?: number };
  /** Ends of the cutting edge in metres. */
  blade?: { heel: number[]; tip: number[] };
  title?: string;
}
