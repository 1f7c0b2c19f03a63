// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import type { PlotPart } from './findings.ts';

/** Okabe and Ito's colours, told apart by every eye, the darkest first. */
const colours = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#000000'];
const dashes = [[], [8, 4], [2, 3], [10, 3, 2, 3], [5, 5], [1, 4], [12, 6]];

/** Series have places of their own on x; the plot wants one list of all places, with holes. */
export function align(series: PlotPart['series']): (number | null)[][] {
  const places = [...new Set(series.flatMap(({ x }) => x))].sort((a, b) => a - b);
  const row = new Map(places.map((x, i) => [x, i]));
  return [places, ...series.map(({ x, y }) => {
    const column: (number | null)[] = places.map(() => null);
    x.forEach((place, i) => { column[row.get(place)!] = y[i]; });
    return column;
  })];
}

const format = (values: (number | null)[]) => values.map((value) => (value === null ? '' : String(Number(value.toPrecision(4)))));

export function drawPlot(part: PlotPart, parent: HTMLElement): void {
  const [places, ...columns] = align(part.series);
  new uPlot({
    width: Math.min(1060, Math.max(320, parent.clientWidth)),
    height: 380,
    cursor: { drag: { x: false, y: false } },
    legend: { live: false },
    scales: { x: { time: false, distr: part.log_x ? 3 : 1, ...(part.log_x ? { range: (_: uPlot, low: number, high: number): [number, number] => [low / 1.1, high * 1.1] } : {}) }, y: { distr: part.log_y ? 3 : 1, ...(part.log_y ? {} : { range: (_: uPlot, low: number, high: number): [number, number] => [Math.min(0, low), high * 1.08] }) } },
    axes: [
      { label: part.x_label, values: (_, values) => format(values), space: 50, ...(part.log_x ? { filter: (_: uPlot, places: number[]) => places.map((place) => (Number(place.toPrecision(1)) === place ? place : null)) } : {}) },
      { label: part.y_label, values: (_, values) => format(values), size: 70 },
    ],
    series: [{ label: part.x_label }, ...part.series.map(({ name, points }, i) => ({
      label: name, stroke: colours[i % colours.length], width: points ? 0 : 2, dash: dashes[i % dashes.length], spanGaps: !points,
      points: { show: points || places.length < 40, size: points ? 5 : 7, fill: colours[i % colours.length] },
    }))],
  }, [places, ...columns] as uPlot.AlignedData, parent);
}
