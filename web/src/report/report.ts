// SPDX-License-Identifier: Apache-2.0
// The report of `resect lab`: its findings are in the page, and it draws them where it is read.
import './report.css';
import { drawStrip } from '../picture.ts';
import { make } from '../simulator/elements.ts';
import type { Findings, StripPart, TablePart } from './findings.ts';
import { drawPlot } from './plot.ts';

const isNumber = (text: string) => /^[<+-]?[\d.,e+-]+( ?%)?$/.test(text);

function drawTable({ columns, rows }: TablePart, parent: HTMLElement): void {
  // A column is of numbers if its first row is.
  const side = columns.map((_, i) => (isNumber(rows[0]?.[i] ?? '') ? '' : 'text'));
  const table = make('table'), head = make('thead'), body = make('tbody'), titles = make('tr');
  titles.append(...columns.map((column, i) => make('th', column, side[i])));
  head.append(titles);
  for (const row of rows) {
    const line = make('tr', '', row.some((cell) => cell === 'Resect' || cell === 'ours') ? 'ours' : '');
    line.append(...row.map((cell, i) => make('td', cell, side[i])));
    body.append(line);
  }
  table.append(head, body);
  parent.classList.add('scroll');
  parent.append(table);
}

/** Drawn once it comes near, one after the other: a processor takes seconds for each. */
function awaitStrip(part: StripPart, parent: HTMLElement): void {
  parent.classList.add('strip');
  parent.append(make('div', 'Drawing', 'wait'));
  const draw = () => {
    const panel = Math.min(420, Math.max(260, Math.floor(1184 / part.surfaces.length)));
    try {
      parent.replaceChildren(drawStrip({ surfaces: part.surfaces, camera: part.camera, size: [panel * part.surfaces.length, Math.round(1.15 * panel)] }));
    } catch (error) {
      parent.replaceChildren(make('div', `Not drawn: ${(error as Error).message}`, 'wait'));
    }
    parent.dataset.drawn = 'true';
  };
  const watcher = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    watcher.disconnect();
    setTimeout(draw, 30);
  }, { rootMargin: '300px' });
  watcher.observe(parent);
}

function drawReport(findings: Findings): void {
  const article = make('article'), list = make('nav');
  article.append(make('h1', findings.title), make('p', findings.machine, 'machine'), list);
  document.body.append(article);
  findings.sections.forEach((section, i) => {
    const title = make('h2', section.title), link = make('a', section.title);
    title.id = `section-${i}`;
    link.setAttribute('href', `#section-${i}`);
    list.append(link);
    article.append(title, ...section.text.map((text) => make('p', text)));
    for (const part of section.parts) {
      const box = make('div');
      box.id = part.name;
      article.append(make('h3', part.title), make('p', part.says, 'says'), box);
      if (part.kind === 'plot') drawPlot(part, box);
      else if (part.kind === 'table') drawTable(part, box);
      else awaitStrip(part, box);
      article.append(make('div', part.kind === 'strip' ? `${part.name}/*.vtp` : `${part.name}.csv`, 'file'));
    }
  });
}

drawReport(JSON.parse(document.getElementById('report')?.textContent ?? '{"title":"No findings","machine":"","sections":[]}') as Findings);
