// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import { make } from './elements.ts';

const seconds = 20;
const samplesAtMost = 20 * seconds;

export interface PlotLine {
  name: string;
  colour: string;
}

/** The last seconds of a few figures. */
export class LivePlot {
  private readonly plot: uPlot;
  private readonly data: number[][];
  private readonly shown: HTMLElement;
  private readonly show: (values: number[]) => string;

  constructor(parent: HTMLElement, title: string, lines: PlotLine[], show: (values: number[]) => string) {
    const box = make('div', '', 'plot'), caption = make('h3', title);
    this.shown = make('b');
    caption.append(this.shown);
    box.append(caption);
    parent.append(box);
    this.show = show;
    this.data = [[], ...lines.map(() => [])];
    this.plot = new uPlot({
      width: Math.max(160, parent.clientWidth - 2),
      height: 46,
      padding: [3, 0, 3, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: { x: { time: false }, y: { range: (_, low, high) => [Math.min(0, low), Math.max(high * 1.1, 1e-9)] } },
      axes: [{ show: false }, { show: false }],
      series: [{}, ...lines.map(({ name, colour }) => ({ label: name, stroke: colour, width: 1.5, points: { show: false } }))],
    }, this.data as uPlot.AlignedData, box);
  }

  add(time: number, values: number[]): void {
    this.shown.textContent = this.show(values);
    this.data[0].push(time);
    values.forEach((value, i) => this.data[i + 1].push(value));
    while (this.data[0].length > samplesAtMost || this.data[0][0] < time - seconds) this.data.forEach((column) => column.shift());
    this.plot.setData(this.data as uPlot.AlignedData);
  }
}
