// SPDX-License-Identifier: Apache-2.0
import { byId, make } from './elements.ts';
import { LivePlot } from './plots.ts';
import type { Status } from './protocol.ts';

const accent = '#66d9c6', second = '#f2c14e', third = '#8aa8ff', fourth = '#f08a8a';

/** The step beside the bound below which every step is surely stable, as the body is strained now. */
export function describeMargin({ used, live_bound }: Status['time_step']): string {
  const share = used / live_bound;
  return `${(100 * share).toFixed(0)} %`;
}

export function describeState(status: Status): string {
  if (status.state === 'diverged') return 'The simulation diverged: undo (Ctrl-Z) or reset (R)';
  if (status.state === 'paused') return `Paused at ${status.time.toFixed(2)} s`;
  const slow = status.pace < 0.85 * status.speed && status.real_time_factor < 1.2 * status.speed;
  const pace = slow ? `slowed to ${status.pace.toFixed(2)} × real time: this machine is too slow for more` : status.speed === 1 ? 'real time' : `${status.speed} × real time`;
  return `${status.time.toFixed(1)} s · ${pace}`;
}

/** The list of numbers and the plots. */
export class FigurePanel {
  private readonly plots: { plot: LivePlot; values: (status: Status, frameMs: number) => number[] }[];
  private readonly facts = new Map<string, HTMLElement>();

  constructor() {
    const parent = byId('plots');
    const energies = (e: Status['energies']) => [e.kinetic, e.elastic];
    this.plots = [
      { plot: new LivePlot(parent, 'Frame of the page', [{ name: 'ms', colour: accent }], ([ms]) => `${ms.toFixed(0)} ms`), values: (_, ms) => [ms] },
      { plot: new LivePlot(parent, 'Could run at', [{ name: 'factor', colour: second }], ([f]) => `${f.toFixed(1)} × real time`), values: (s) => [s.real_time_factor] },
      { plot: new LivePlot(parent, 'Cut, longest tick', [{ name: 'us', colour: fourth }], ([us]) => `${us.toFixed(0)} µs`), values: (s) => [s.cut_us] },
      { plot: new LivePlot(parent, 'Energy: kinetic, elastic', [{ name: 'kinetic', colour: third }, { name: 'elastic', colour: accent }], (e) => e.map((x) => `${(1000 * x).toPrecision(2)}`).join(', ') + ' mJ'), values: (s) => energies(s.energies) },
      { plot: new LivePlot(parent, 'Element copies', [{ name: 'copies', colour: second }], ([n]) => n.toLocaleString('en')), values: (s) => [s.elements] },
    ];
  }

  show(status: Status, frameMs: number): void {
    this.fact('Steps per second', Math.round(status.step_rate).toLocaleString('en'));
    this.fact('Step', `${(1000 * status.time_step.used).toFixed(3)} ms`);
    this.fact('Step, of its sure bound', describeMargin(status.time_step));
    this.fact('Elements cut', status.cut_elements.toLocaleString('en'));
    this.fact('Stretch', `${status.strain.stretch_min.toFixed(2)} to ${status.strain.stretch_max.toFixed(2)}`);
    const pieces = status.pieces.slice(0, 3).map((one) => `${(1e6 * one.volume).toFixed(0)}`);
    const more = status.piece_count > 3 ? ` +${status.piece_count - 3}` : '';
    this.fact(status.piece_count === 1 ? 'One piece' : `${status.piece_count} pieces`, `${pieces.join(', ')}${more} cm³`, 'pieces');
    this.showWarning(status.warnings[0]);
    if (!byId<HTMLDetailsElement>('figures').open) return;
    const now = performance.now() / 1000;
    for (const { plot, values } of this.plots) plot.add(now, values(status, frameMs));
  }

  private fact(name: string, value: string, key = name): void {
    let shown = this.facts.get(key);
    if (!shown) {
      shown = make('dd');
      byId('facts').append(make('dt', name), shown);
      this.facts.set(key, shown);
    }
    if (shown.previousElementSibling!.textContent !== name) shown.previousElementSibling!.textContent = name;
    if (shown.textContent !== value) shown.textContent = value;
  }

  private showWarning(warning: string | undefined): void {
    let shown = this.facts.get('warning');
    if (!shown) {
      shown = make('dd', '', 'wide');
      byId('facts').append(shown);
      this.facts.set('warning', shown);
    }
    shown.hidden = warning === undefined;
    if (warning && shown.textContent !== warning) shown.textContent = warning;
  }
}
