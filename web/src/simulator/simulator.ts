// SPDX-License-Identifier: Apache-2.0
import { Vector3 } from 'three';
import { Body } from './body.ts';
import { Film, download, savePicture } from './capture.ts';
import { Connection } from './connection.ts';
import { byId, make, toast } from './elements.ts';
import { FigurePanel, describeState } from './figures.ts';
import { GraspTool } from './grasp_tool.ts';
import { icon, type Icon } from './icons.ts';
import { LineTool } from './line_tool.ts';
import { ElementLines, GraspMarkers, ScalpelModel, StrokeTrace } from './overlays.ts';
import { pick } from './pick.ts';
import { Pointer } from './pointer.ts';
import { ProbeTool } from './probe_tool.ts';
import type { EngineText, Frame, Request, SceneEntry, SceneFacts, Status } from './protocol.ts';
import { ScalpelTool } from './scalpel_tool.ts';
import { TissueOptions, ToolOptions } from './settings.ts';
import { Stage, type Quality } from './stage.ts';
import type { Room, Tool, ToolSettings } from './tool.ts';
import { Views } from './views.ts';

type ToolName = 'scalpel' | 'line' | 'grasp' | 'probe' | 'turn';

const toolFaces: { name: ToolName; label: string; cursor: string }[] = [
  { name: 'scalpel', label: 'Scalpel', cursor: 'cut' },
  { name: 'line', label: 'Line', cursor: 'cut' },
  { name: 'grasp', label: 'Grasper', cursor: 'grab' },
  { name: 'probe', label: 'Probe', cursor: 'cut' },
  { name: 'turn', label: 'Turn', cursor: 'turn' },
];

/** Steps down from fine to fast, taken while frames come slower than this, ms. */
const qualities: [Quality, number][] = [['high', 1], ['low', 1], ['low', 0.75], ['low', 0.5]];
const slowFrame = 45;
/** Judged after so many frames, or so long, ms. */
const framesJudged = 12, longJudged = 900;
/** Two seconds of frames, for tests. */
const framesRemembered = 120;
const slowMotion = 0.2;

/** The view's own hand: nothing is the tool's. */
const turnTool: Tool = { wants: () => false, hover() {}, press() {}, drag() {}, release() {}, rest() {} };

class Simulator {
  readonly body = new Body();
  readonly stage: Stage;
  readonly connection: Connection;
  readonly latency: number[] = [];
  status: Status | undefined;
  scene: SceneFacts | undefined;
  frame: Pick<Frame, 'frame' | 'message' | 'step' | 'vertices' | 'triangles' | 'revision'> | undefined;
  driving = false;
  /** Of the last frames, ms. */
  readonly scripts: number[] = [];

  private readonly settings: ToolSettings = { depth: 0.03, lean: 0, alongView: false, radius: 0.01, pin: false };
  private readonly tools: Record<ToolName, Tool>;
  private tool: ToolName = 'scalpel';
  private readonly pointer: Pointer;
  private readonly views: Views;
  private readonly elements: ElementLines;
  private readonly toolOptions: ToolOptions;
  private readonly tissueOptions: TissueOptions;
  private readonly figures = new FigurePanel();
  private readonly film = new Film();
  private isDirty = true;
  private isNewScene = true;
  private isOtherBody = true;
  private frameMs = 16;
  private lastDraw = 0;
  private qualityAt = 0;
  private judged: number[] = [];
  private handled = 0;
  private readonly hashes = new Map<number, (hash: string) => void>();

  constructor() {
    const canvas = byId<HTMLCanvasElement>('view');
    this.stage = new Stage(canvas, this.body.geometry, [48, 24]);
    this.connection = new Connection(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/ws`, {
      opened: () => this.hideCurtain(),
      closed: () => this.showCurtain('The engine has stopped. Start it again with ./run; this page goes on by itself.'),
      text: (text) => this.hearText(text),
      frame: (frame) => this.hearFrame(frame),
      file: ({ name, bytes }) => download(name, new Blob([bytes.slice()])),
      failed: (message) => toast(message),
    });
    const room: Room = {
      stage: this.stage, body: this.body, connection: this.connection, settings: this.settings,
      readout: (text, x, y) => showReadout(text, x, y),
    };
    const trace = new StrokeTrace(this.stage.scene);
    this.elements = new ElementLines(this.stage.scene);
    this.tools = {
      scalpel: new ScalpelTool(room, new ScalpelModel(this.stage.scene), trace),
      line: new LineTool(room, trace, () => (this.status?.paused ? 1 : this.status?.speed ?? 1)),
      grasp: new GraspTool(room, new GraspMarkers(this.stage.scene)),
      probe: new ProbeTool(room, () => this.status?.pieces ?? []),
      turn: turnTool,
    };
    this.views = new Views(this.stage, this.elements, trace, () => this.askForFields());
    this.toolOptions = new ToolOptions(this.settings);
    this.tissueOptions = new TissueOptions(() => this.connection);
    this.pointer = new Pointer(canvas, this.stage.controls, () => this.tools[this.tool]);
    this.stage.controls.addEventListener('change', () => (this.isDirty = true));
    this.buildBars();
    this.listen(canvas);
    this.takeTool('scalpel');
    this.chooseQuality();
    this.resize();
    requestAnimationFrame((now) => this.draw(now));
  }

  get isLoading(): boolean {
    return this.isNewScene;
  }

  send(request: Request): number {
    return this.connection.send(request);
  }

  askHash(): Promise<string> {
    const id = this.send({ hash: true });
    return new Promise((answer) => this.hashes.set(id, answer));
  }

  pick(x: number, y: number) {
    const hit = pick(this.body, this.stage.rayAt(x, y));
    return hit ? { point: hit.point.toArray(), vertex: this.body.index.values[3 * hit.triangle], piece: this.body.piece.values[hit.triangle] } : null;
  }

  // ---- what the engine says

  private hearText(text: EngineText): void {
    if (text.hello) {
      this.driving = text.hello.driving;
      this.showScenes(text.hello.scenes);
      this.askForFields();
    }
    if (text.driving) {
      this.driving = text.driving.driving;
      byId('watching').hidden = this.driving;
    }
    if (text.loading) this.showCurtain(`${text.loading.title}: settling…`);
    if (text.scene) this.showScene(text.scene);
    if (text.status) this.showStatus(text.status);
    if (text.refused) toast(sentence(text.refused.message));
    if (text.notice) toast(sentence(text.notice.message));
    if (text.saved) toast(text.saved.path.endsWith('.json') ? `Saved. Replay it: ./run replay ${text.saved.path} --check-hash` : `Saved as ${text.saved.path}`, true);
    if (text.hash) {
      this.hashes.get(text.hash.id)?.(text.hash.hash);
      this.hashes.delete(text.hash.id);
    }
  }

  private hearFrame(frame: Frame): void {
    const began = performance.now();
    this.body.apply(frame);
    this.stage.body.visible = true;
    if (frame.stress) this.views.updateRange(this.body);
    if (frame.node) this.elements.apply(frame.node, frame.element);
    if (this.isNewScene) this.stage.lookAround();
    if (this.isOtherBody) this.frameBody();
    this.isNewScene = this.isOtherBody = false;
    this.frame = { frame: frame.frame, message: frame.message, step: frame.step, vertices: frame.vertices, triangles: frame.triangles, revision: frame.revision };
    this.noteLatency(frame.message);
    this.isDirty = true;
    this.handled += performance.now() - began;
  }

  private noteLatency(message: number): void {
    this.latency.push(...this.connection.takeLatencies(message));
    if (this.latency.length > 1000) this.latency.splice(0, this.latency.length - 1000);
  }

  private showScenes(scenes: SceneEntry[]): void {
    byId('scene-list').replaceChildren(...scenes.map(({ name, title, description }) => {
      const button = make('button');
      button.type = 'button';
      button.title = description.split('. ')[0];
      button.dataset.scene = name;
      button.append(pictureOf(name), make('span', title));
      button.addEventListener('click', () => this.send({ scene: name }));
      const row = make('li');
      row.append(button);
      return row;
    }));
  }

  private showScene(scene: SceneFacts): void {
    this.isOtherBody = this.scene?.name !== scene.name;
    this.scene = scene;
    this.isNewScene = true;
    if (this.isOtherBody) this.stage.surround(new Vector3(...scene.lo), new Vector3(...scene.hi));
    this.tissueOptions.showScene(scene);
    for (const tool of Object.values(this.tools)) tool.forget?.();
    for (const button of byId('scene-list').querySelectorAll('button')) button.setAttribute('aria-current', String(button.dataset.scene === scene.name));
    for (const note of scene.notes) toast(sentence(note));
    this.hideCurtain();
  }

  private showStatus(status: Status): void {
    this.tissueOptions.follow(status);
    this.status = status;
    const line = byId('state');
    line.textContent = `${this.scene?.title ?? ''} · ${describeState(status)}`;
    line.classList.toggle('warn', status.state === 'diverged');
    setPressed('pause', status.paused);
    setPressed('slow', status.speed < 1);
    byId<HTMLButtonElement>('action-step').disabled = !status.paused;
    byId<HTMLButtonElement>('action-undo').disabled = status.strokes === 0;
    this.figures.show(status, this.frameMs);
  }

  // ---- what the person does

  private takeTool(name: ToolName): void {
    this.tools[this.tool].rest();
    this.tool = name;
    this.toolOptions.show(name);
    toolFaces.forEach((face) => byId(`tool-${face.name}`).setAttribute('aria-checked', String(face.name === name)));
    byId('view').className = toolFaces.find((face) => face.name === name)!.cursor;
    this.askForFields();
    this.isDirty = true;
  }

  /** Sections of frames that only some views and tools need. */
  private askForFields(): void {
    this.isDirty = true;
    const stress = this.views?.current === 'Stress' || this.tool === 'probe';
    this.send({ show: { stress, elements: this.views?.current === 'Elements' } });
  }

  private frameBody(): void {
    this.stage.frame(this.body.position.values.subarray(0, 3 * this.body.vertices));
  }

  private undo(): void {
    this.send({ command: { undo: {} } });
    for (const tool of Object.values(this.tools)) tool.forget?.();
  }

  private togglePin(): void {
    this.settings.pin = !this.settings.pin;
    this.toolOptions.showPin(this.settings.pin);
  }

  private toggleSlow(): void {
    const speed = this.status && this.status.speed < 1 ? 1 : slowMotion;
    this.send({ speed });
    this.tissueOptions.showSpeed(speed);
  }

  private toggleFilm(): void {
    try {
      if (this.film.isOn) this.film.stop();
      else this.film.start(this.stage.renderer.domElement);
      setPressed('video', this.film.isOn);
    } catch (error) {
      toast((error as Error).message);
    }
  }

  private readonly actions: { name: string; face: Icon; label: string; key: string; words: string; run: () => void }[] = [
    { name: 'undo', face: 'undo', label: 'Undo', key: 'Ctrl-Z', words: 'take the last stroke back', run: () => this.undo() },
    { name: 'reset', face: 'reset', label: 'Reset', key: 'R', words: 'start the scene anew', run: () => this.send({ reset: true }) },
    { name: 'pause', face: 'pause', label: 'Pause', key: 'Space', words: 'stop, and go on', run: () => this.send({ pause: !this.status?.paused }) },
    { name: 'step', face: 'step', label: 'Step', key: '.', words: 'one step, while paused', run: () => this.send({ step: 1 }) },
    { name: 'slow', face: 'slow', label: 'Slow', key: 'S', words: 'slow motion', run: () => this.toggleSlow() },
    { name: 'picture', face: 'picture', label: 'Picture', key: 'I', words: 'save a picture of the view', run: () => savePicture(this.stage.renderer.domElement) },
    { name: 'video', face: 'video', label: 'Video', key: 'O', words: 'film the view, until pressed again', run: () => this.toggleFilm() },
    { name: 'save', face: 'save', label: 'Save', key: 'D', words: 'save the record, the surface, or the mesh', run: () => byId<HTMLDialogElement>('save').showModal() },
    { name: 'help', face: 'help', label: 'Keys', key: '?', words: 'this sheet', run: () => byId<HTMLDialogElement>('help').showModal() },
  ];

  private buildBars(): void {
    const keys: [string, string][] = [];
    toolFaces.forEach(({ name, label }, i) => {
      const button = barButton(`tool-${name}`, name, label, `${label} (${i + 1})`);
      button.setAttribute('role', 'radio');
      button.addEventListener('click', () => this.takeTool(name));
      byId('tools').append(button);
      keys.push([String(i + 1), label]);
    });
    for (const { name, face, label, key, words, run } of this.actions) {
      const button = barButton(`action-${name}`, face, label, `${label}: ${words} (${key})`);
      button.addEventListener('click', run);
      byId('actions').append(button);
      keys.push([key, `${label}: ${words}`]);
    }
    keys.push(['V', 'next view'], ['F', 'the whole body in view'], ['P', 'pin what the grasper lets go'], ['Right drag', 'turn the view'], ['Wheel', 'zoom'], ['Middle drag', 'move the view'], ['Two fingers', 'zoom and move; one finger beside the body turns']);
    byId('keys').append(...keys.flatMap(([key, words]) => [make('dt', key), make('dd', words)]));
  }

  private pressKey(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if (target.closest('dialog, input:not([type="range"], [type="checkbox"]), textarea')) return;
    // A button reached by keys is pressed by Space; one that was clicked is not meant any more.
    if (event.key === ' ' && target.closest('button, summary, [type="checkbox"]')?.matches(':focus-visible')) return;
    const key = event.key.toLowerCase();
    const isUndo = key === 'z' && (event.ctrlKey || event.metaKey);
    if (!isUndo && (event.ctrlKey || event.metaKey || event.altKey)) return;
    const names: Record<string, string> = { r: 'reset', ' ': 'pause', '.': 'step', s: 'slow', i: 'picture', o: 'video', d: 'save', '?': 'help' };
    const action = this.actions.find(({ name }) => name === (isUndo ? 'undo' : names[key]));
    const tool = toolFaces[Number(key) - 1];
    if (action) action.run();
    else if (tool) this.takeTool(tool.name);
    else if (key === 'v') this.views.next();
    else if (key === 'f') this.frameBody();
    else if (key === 'p') this.togglePin();
    else return;
    event.preventDefault();
  }

  private listen(canvas: HTMLCanvasElement): void {
    window.addEventListener('resize', () => this.resize());
    window.addEventListener('keydown', (event) => this.pressKey(event));
    canvas.addEventListener('pointerdown', () => byId('hint').hidden || this.closeHint());
    byId('take-over').addEventListener('click', () => this.send({ drive: true }));
    byId('hint').hidden = localStorage.getItem('resect-hint') === 'seen';
    byId('hint-close').addEventListener('click', () => this.closeHint());
    for (const button of byId('save').querySelectorAll<HTMLButtonElement>('button[value]')) {
      if (button.value) button.addEventListener('click', () => this.send({ save: button.value }));
    }
    const file = byId<HTMLInputElement>('file');
    byId('open-file').addEventListener('click', () => file.click());
    file.addEventListener('change', () => {
      if (file.files?.[0]) void this.openFile(file.files[0]);
      file.value = '';
    });
    this.listenToDrops();
  }

  private listenToDrops(): void {
    window.addEventListener('dragover', (event) => {
      event.preventDefault();
      byId('drop').hidden = false;
    });
    byId('drop').addEventListener('dragleave', () => (byId('drop').hidden = true));
    window.addEventListener('drop', (event) => {
      event.preventDefault();
      byId('drop').hidden = true;
      const file = event.dataTransfer?.files[0];
      if (file) void this.openFile(file);
    });
  }

  private async openFile(file: File): Promise<void> {
    const most = 64 << 20;
    if (file.size > most - 4096) toast(`${file.name} has ${(file.size / 1048576).toFixed(0)} MiB; a page may send 64`);
    else this.connection.upload(file.name, new Uint8Array(await file.arrayBuffer()));
  }

  private closeHint(): void {
    byId('hint').hidden = true;
    localStorage.setItem('resect-hint', 'seen');
    byId('view').focus();
  }

  private showCurtain(words: string): void {
    byId('curtain-text').textContent = words;
    byId('curtain').hidden = false;
  }

  private hideCurtain(): void {
    byId('curtain').hidden = true;
  }

  // ---- drawing

  private resize(): void {
    const isTiny = new URLSearchParams(location.search).has('pixel'); // to measure the script alone
    if (isTiny) Object.assign(this.stage.renderer.domElement.style, { width: '1px', height: '1px' });
    this.stage.resize(isTiny ? 1 : window.innerWidth, isTiny ? 1 : window.innerHeight);
    this.isDirty = true;
  }

  /** `?quality=high` or `low` keeps one; otherwise slow frames step down, and a processor begins below. */
  private chooseQuality(): void {
    const told = new URLSearchParams(location.search).get('quality');
    if (told === 'low' || (!told && this.stage.isDrawnByProcessor)) this.qualityAt = 1;
    this.stage.setQuality(...qualities[this.qualityAt]);
    if (told) this.qualityAt = qualities.length - 1;
  }

  private judge(interval: number): void {
    this.judged.push(interval);
    const passed = this.judged.reduce((sum, one) => sum + one, 0);
    if (this.judged.length < framesJudged && passed < longJudged) return;
    const middle = this.judged.sort((a, b) => a - b)[this.judged.length >> 1];
    this.judged = [];
    if (middle < slowFrame || this.qualityAt + 1 >= qualities.length || document.hidden) return;
    this.stage.setQuality(...qualities[++this.qualityAt]);
  }

  private draw(now: number): void {
    requestAnimationFrame((next) => this.draw(next));
    const began = performance.now();
    // A film has a frame only where something is drawn.
    if (this.pointer.tick() || this.film.isOn) this.isDirty = true;
    for (const tool of Object.values(this.tools)) tool.tick?.(); // a line goes on when another tool is taken
    if (!this.isDirty) {
      this.lastDraw = 0;
      return;
    }
    this.isDirty = false;
    this.stage.draw();
    if (this.lastDraw > 0) {
      this.frameMs += 0.1 * (now - this.lastDraw - this.frameMs);
      this.judge(now - this.lastDraw);
    }
    this.lastDraw = now;
    this.scripts.push(performance.now() - began + this.handled);
    if (this.scripts.length > framesRemembered) this.scripts.shift();
    this.handled = 0;
  }
}

function barButton(id: string, face: string, label: string, words: string): HTMLButtonElement {
  const button = make('button');
  button.type = 'button';
  button.id = id;
  button.title = words;
  button.setAttribute('aria-label', words);
  button.append(icon(face as Icon), make('span', label));
  return button;
}

/** Set when the page is built, so that none is asked for in vain. */
declare const SCENES_WITH_PICTURES: string[];

function pictureOf(scene: string): HTMLElement {
  if (!SCENES_WITH_PICTURES.includes(scene)) return make('div', '', 'blank');
  const picture = make('img');
  picture.src = `thumbnails/${scene}.png`;
  picture.alt = '';
  return picture;
}

function setPressed(action: string, on: boolean): void {
  byId(`action-${action}`).setAttribute('aria-pressed', String(on));
}

function sentence(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

function showReadout(text: string | undefined, x: number, y: number): void {
  const box = byId('readout');
  box.hidden = text === undefined;
  if (text === undefined) return;
  box.textContent = text;
  box.style.left = `${Math.min(x + 18, window.innerWidth - 300)}px`;
  box.style.top = `${Math.min(y + 18, window.innerHeight - 120)}px`;
}

/** What tests may see and do. */
function open(simulator: Simulator): object {
  return {
    get ready() {
      return simulator.frame !== undefined && simulator.status !== undefined && !simulator.isLoading;
    },
    get status() { return simulator.status; },
    get scene() { return simulator.scene; },
    get frame() { return simulator.frame; },
    get driving() { return simulator.driving; },
    get scripts() { return simulator.scripts; },
    get latency() { return simulator.latency; },
    /** From the camera to what it turns round. */
    get distance() { return simulator.stage.camera.position.distanceTo(simulator.stage.controls.target); },
    get heading() { return simulator.stage.camera.getWorldDirection(new Vector3()).toArray(); },
    screenOf: (point: [number, number, number]) => simulator.stage.screenOf(new Vector3(...point)),
    pick: (x: number, y: number) => simulator.pick(x, y),
    vertex: (row: number) => [...simulator.body.position.values.subarray(3 * row, 3 * row + 3)],
    send: (request: Request) => simulator.send(request),
    hash: () => simulator.askHash(),
  };
}

try {
  Object.assign(window, { resect: open(new Simulator()) });
} catch (error) {
  byId('curtain-text').textContent = (error as Error).message;
  byId('curtain').hidden = false;
}
