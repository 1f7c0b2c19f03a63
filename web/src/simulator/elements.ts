// SPDX-License-Identifier: Apache-2.0
// Small pieces of the page.

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

export function make<K extends keyof HTMLElementTagNameMap>(tag: K, text = '', className = ''): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  if (text) element.textContent = text;
  if (className) element.className = className;
  return element;
}

export interface Slider {
  input: HTMLInputElement;
  /** Shows a value without telling anybody. */
  set(value: number): void;
  /** The same, but not under somebody's hand. */
  follow(value: number): void;
}

export interface SliderOptions {
  label: string;
  lo: number;
  hi: number;
  value: number;
  /** Equal ways of the hand are equal ratios. */
  logarithmic?: boolean;
  show(value: number): string;
  change(value: number): void;
}

/** After a touch, until what it asked for has come back, ms. */
const quiet = 1000;

export function addSlider(parent: HTMLElement, { label, lo, hi, value, logarithmic = false, show, change }: SliderOptions): Slider {
  const row = make('div', '', 'setting');
  const id = `slider-${label.toLowerCase().replace(/[^a-z]+/g, '-')}`;
  const caption = make('label', label), shown = make('output'), input = make('input');
  caption.htmlFor = input.id = id;
  shown.setAttribute('for', id);
  const fromShare = (share: number) => (logarithmic ? lo * (hi / lo) ** share : lo + share * (hi - lo));
  const toShare = (at: number) => (logarithmic ? Math.log(at / lo) / Math.log(hi / lo) : (at - lo) / (hi - lo));
  Object.assign(input, { type: 'range', min: '0', max: '1', step: '0.001' });
  const set = (at: number) => {
    input.value = String(toShare(at));
    shown.value = show(at);
    input.setAttribute('aria-valuetext', show(at));
  };
  let touched = -Infinity; // ms
  input.addEventListener('input', () => {
    touched = performance.now();
    const at = fromShare(Number(input.value));
    shown.value = show(at);
    input.setAttribute('aria-valuetext', show(at));
    change(at);
  });
  set(value);
  row.append(caption, shown, input);
  parent.append(row);
  const follow = (at: number) => {
    if (performance.now() - touched > quiet) set(at);
  };
  return { input, set, follow };
}

export function addCheck(parent: HTMLElement, label: string, value: boolean, change: (on: boolean) => void): HTMLInputElement {
  const row = make('label', '', 'check'), input = make('input');
  input.type = 'checkbox';
  input.checked = value;
  input.addEventListener('change', () => change(input.checked));
  row.append(input, label);
  parent.append(row);
  return input;
}

const toastFor = 6000;

/** A line at the foot of the page that goes away. */
export function toast(message: string, good = false): void {
  const shown = byId('toasts');
  const same = [...shown.children].find((one) => one.textContent === message);
  same?.remove();
  const line = make('div', message, good ? 'toast good' : 'toast');
  shown.append(line);
  while (shown.children.length > 3) shown.firstChild?.remove();
  setTimeout(() => line.remove(), toastFor);
}

/** Runs at most once in `pause` ms, and in the end with the last value. */
export function throttled<T>(pause: number, run: (value: T) => void): (value: T) => void {
  let waiting: T | undefined;
  let timer: ReturnType<typeof setTimeout> | undefined;
  const fire = () => {
    timer = undefined;
    if (waiting === undefined) return;
    const value = waiting;
    waiting = undefined;
    run(value);
    timer = setTimeout(fire, pause);
  };
  return (value) => {
    waiting = value;
    if (timer === undefined) fire();
  };
}
