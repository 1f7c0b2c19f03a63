// SPDX-License-Identifier: Apache-2.0

/** Paths in a square of 24 by 24. */
const paths = {
  scalpel: 'M3 21l6-6M8 13l3 3 9-9c1-1 1-3 0-4-1-1-2-1-3 0z',
  line: 'M4 20L20 4M4 20h0M20 4h0M3 15l6 6M15 3l6 6',
  grasp: 'M6 3l5 9M18 3l-5 9M9 15a3 3 0 1 1-6 3 3 3 0 0 1 6-3zM21 18a3 3 0 1 1-6-3 3 3 0 0 1 6 3zM11 12l2 0',
  probe: 'M10 4a6 6 0 1 0 0 12 6 6 0 0 0 0-12zM15 15l6 6M10 7v6M7 10h6',
  turn: 'M20 12a8 8 0 1 1-3-6M20 3v4h-4',
  undo: 'M9 7L4 12l5 5M4 12h10a5 5 0 0 1 0 10h-2',
  reset: 'M4 12a8 8 0 1 0 3-6M4 3v4h4',
  pause: 'M8 5v14M16 5v14',
  play: 'M7 4l12 8-12 8z',
  step: 'M6 5l9 7-9 7zM18 5v14',
  slow: 'M12 7v5l3 3M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18z',
  picture: 'M4 7h4l2-3h4l2 3h4v12H4zM12 10a3 3 0 1 0 0 6 3 3 0 0 0 0-6z',
  video: 'M3 7h12v10H3zM15 11l6-4v10l-6-4',
  save: 'M12 4v11M7 11l5 5 5-5M4 20h16',
  help: 'M9 9a3 3 0 1 1 4 3c-1 .5-1 1-1 2M12 18h0M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18z',
};
export type Icon = keyof typeof paths;

export function icon(name: Icon): SVGSVGElement {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg'), path = document.createElementNS(space, 'path');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  path.setAttribute('d', paths[name]);
  svg.append(path);
  return svg;
}
