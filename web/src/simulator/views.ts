// SPDX-License-Identifier: Apache-2.0
import { Plane, Vector3 } from 'three';
import type { Body } from './body.ts';
import { addCheck, addSlider, byId, make } from './elements.ts';
import { scaleColours } from './live_material.ts';
import type { ElementLines, StrokeTrace } from './overlays.ts';
import type { Stage } from './stage.ts';

export const viewNames = ['Tissue', 'Stress', 'Pieces', 'Elements', 'Sheet'] as const;
export type ViewName = (typeof viewNames)[number];

/** Of the stresses, so that one sharp corner does not darken all. */
const highShare = 0.97;
const samples = 600;

/** How the body is shown, and where it is cut open to look inside. */
export class Views {
  current: ViewName = 'Tissue';
  private readonly stage: Stage;
  private readonly elements: ElementLines;
  private readonly trace: StrokeTrace;
  private readonly changed: () => void;
  private readonly plane = new Plane(new Vector3(1, 0, 0), 0);
  private clips = false;
  private clipAt = 0.5;
  private highest = 0;

  constructor(stage: Stage, elements: ElementLines, trace: StrokeTrace, changed: () => void) {
    this.stage = stage;
    this.elements = elements;
    this.trace = trace;
    this.changed = changed;
    for (const name of viewNames) {
      const button = make('button', name);
      button.type = 'button';
      button.setAttribute('role', 'radio');
      button.addEventListener('click', () => this.show(name));
      byId('views').append(button);
    }
    byId('legend-bar').style.background = `linear-gradient(90deg, ${scaleColours.join(', ')})`;
    addCheck(byId('view-options'), 'Clip', false, (on) => {
      this.clips = on;
      slider.hidden = !on;
      this.stage.setClip(on ? this.plane : undefined);
      this.placeClip();
    });
    const slider = make('div');
    slider.hidden = true;
    byId('view-options').append(slider);
    addSlider(slider, {
      label: 'Clip at', lo: 0, hi: 1, value: 0.5, show: (value) => `${(100 * value).toFixed(0)} %`,
      change: (value) => {
        this.clipAt = value;
        this.placeClip();
      },
    });
    this.show('Tissue');
  }

  show(name: ViewName): void {
    this.current = name;
    [...byId('views').children].forEach((button, i) => button.setAttribute('aria-checked', String(viewNames[i] === name)));
    this.stage.tissue.setPaint(name === 'Stress' ? 'stress' : name === 'Pieces' ? 'pieces' : 'tissue');
    this.stage.tissue.setTranslucent(name === 'Elements' || name === 'Sheet');
    this.elements.show(name === 'Elements');
    this.trace.showSheet(name === 'Sheet');
    byId('legend').hidden = name !== 'Stress';
    this.highest = 0;
    this.changed();
  }

  next(): void {
    this.show(viewNames[(viewNames.indexOf(this.current) + 1) % viewNames.length]);
  }

  /** The colours follow the stresses, slowly. */
  updateRange(body: Body): void {
    if (this.current !== 'Stress') return;
    const stride = Math.max(1, Math.floor(body.vertices / samples));
    const drawn: number[] = [];
    for (let i = 0; i < body.vertices; i += stride) drawn.push(body.stress.values[i]);
    drawn.sort((a, b) => a - b);
    const high = drawn[Math.floor(highShare * (drawn.length - 1))] ?? 0;
    this.highest = this.highest === 0 ? high : this.highest + 0.1 * (high - this.highest);
    this.stage.tissue.setRange(0, this.highest);
    byId('legend-low').textContent = '0';
    byId('legend-high').textContent = `${(this.highest / 1000).toPrecision(2)} kPa`;
  }

  private placeClip(): void {
    const { center, radius } = this.stage.bounds;
    if (this.clips) this.plane.setFromNormalAndCoplanarPoint(new Vector3(-1, 0, 0), new Vector3(center.x + (2 * this.clipAt - 1) * radius, 0, 0));
    this.changed();
  }
}
