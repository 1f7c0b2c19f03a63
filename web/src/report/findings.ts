// SPDX-License-Identifier: Apache-2.0
// What `resect lab` puts into the page (lab/report.cpp).

export interface PlotPart {
  kind: 'plot';
  name: string; title: string; says: string;
  x_label: string; y_label: string;
  log_x: boolean; log_y: boolean;
  series: { name: string; x: number[]; y: number[]; points: boolean }[];
}

export interface TablePart {
  kind: 'table';
  name: string; title: string; says: string;
  columns: string[];
  rows: string[][];
}

export interface StripPart {
  kind: 'strip';
  name: string; title: string; says: string;
  surfaces: { name: string; caption: string; base64: string }[];
  camera: { eye: number[]; target: number[]; fov: number };
}

export interface Findings {
  title: string;
  machine: string;
  sections: { title: string; text: string[]; parts: (PlotPart | TablePart | StripPart)[] }[];
}
