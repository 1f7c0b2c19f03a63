// SPDX-License-Identifier: Apache-2.0
// What travels between page and engine: docs/protocol.md.

const magic = 0x54435352;
const version = 1;
const headerBytes = 64;
const sectionBytes = 16;
const kindSurface = 1;
const kindFile = 2;

/** Types of sections. */
const section = { position: 1, normal: 2, triangle: 3, face: 4, piece: 5, rest: 6, stress: 7, node: 8, element: 9, name: 16, bytes: 17 } as const;

/** Rows of a table from `first` on, as views of the frame's own bytes. */
export interface Rows<T> {
  first: number;
  rows: number;
  values: T;
}

export interface Frame {
  frame: number;
  /** The last message of the driver whose effect is shown. */
  message: number;
  time: number;
  step: number;
  scene: number;
  revision: number;
  vertices: number;
  triangles: number;
  position: Float32Array;
  normal: Int16Array;
  triangle: Rows<Uint32Array>[];
  face: Rows<Int32Array>[];
  piece: Rows<Int32Array>[];
  rest: Rows<Float32Array>[];
  stress: Float32Array | undefined;
  node: Float32Array | undefined;
  element: Uint32Array | undefined;
}

export interface FileMessage {
  name: string;
  bytes: Uint8Array;
}

interface Section {
  type: number;
  first: number;
  rows: number;
  at: number;
  bytes: number;
}

/** Throws an Error in words where the bytes are not as they should be. */
export function decodeBinary(bytes: ArrayBuffer): { frame: Frame } | { file: FileMessage } {
  const header = new DataView(bytes);
  if (bytes.byteLength < headerBytes || header.getUint32(0, true) !== magic) throw new Error('the engine sent bytes that are no frame');
  if (header.getUint16(4, true) !== version) throw new Error('the engine speaks another version; reload this page');
  const sections = listSections(header);
  const kind = header.getUint16(6, true);
  if (kind === kindFile) return { file: readFile(bytes, sections) };
  if (kind !== kindSurface) throw new Error('the engine sent a frame of an unknown kind; reload this page');
  return { frame: readFrame(bytes, header, sections) };
}

function listSections(bytes: DataView): Section[] {
  const sections: Section[] = [];
  let at = headerBytes;
  for (let i = bytes.getUint32(56, true); i > 0; --i) {
    if (at + sectionBytes > bytes.byteLength) throw new Error('a frame of the engine ends too early');
    const size = bytes.getUint32(at + 12, true);
    const one = { type: bytes.getUint32(at, true), first: bytes.getUint32(at + 4, true), rows: bytes.getUint32(at + 8, true), at: at + sectionBytes, bytes: size };
    if (one.at + size > bytes.byteLength) throw new Error('a frame of the engine ends too early');
    sections.push(one);
    at = one.at + 8 * Math.ceil(size / 8);
  }
  return sections;
}

function readFrame(bytes: ArrayBuffer, header: DataView, sections: Section[]): Frame {
  const find = (type: number) => sections.find((one) => one.type === type);
  const floats = (one: Section) => new Float32Array(bytes, one.at, one.bytes / 4);
  const words = (one: Section) => new Uint32Array(bytes, one.at, one.bytes / 4);
  const numbers = (one: Section) => new Int32Array(bytes, one.at, one.bytes / 4);
  const all = <T>(type: number, view: (one: Section) => T): Rows<T>[] =>
    sections.filter((one) => one.type === type).map((one) => ({ first: one.first, rows: one.rows, values: view(one) }));
  const maybe = <T>(type: number, view: (one: Section) => T): T | undefined => {
    const found = find(type);
    return found && view(found);
  };
  const position = find(section.position), normal = find(section.normal);
  if (!position || !normal) throw new Error('a frame of the engine lacks positions');
  return {
    frame: header.getUint32(8, true),
    message: header.getUint32(12, true),
    time: header.getFloat64(16, true),
    step: header.getFloat64(24, true),
    scene: header.getUint32(32, true),
    revision: header.getUint32(36, true),
    vertices: header.getUint32(40, true),
    triangles: header.getUint32(44, true),
    position: floats(position),
    normal: new Int16Array(bytes, normal.at, normal.bytes / 2),
    triangle: all(section.triangle, words),
    face: all(section.face, numbers),
    piece: all(section.piece, numbers),
    rest: all(section.rest, floats),
    stress: maybe(section.stress, floats),
    node: maybe(section.node, floats),
    element: maybe(section.element, words),
  };
}

function readFile(bytes: ArrayBuffer, sections: Section[]): FileMessage {
  const part = (type: number) => {
    const found = sections.find((one) => one.type === type);
    return new Uint8Array(bytes, found?.at ?? 0, found?.bytes ?? 0);
  };
  return { name: new TextDecoder().decode(part(section.name)), bytes: part(section.bytes) };
}

/** A mesh file for the engine. */
export function encodeUpload(name: string, content: Uint8Array): ArrayBuffer {
  const label = new TextEncoder().encode(name);
  const padded = (size: number) => 8 * Math.ceil(size / 8);
  const bytes = new ArrayBuffer(headerBytes + 2 * sectionBytes + padded(label.length) + padded(content.length));
  const view = new DataView(bytes);
  view.setUint32(0, magic, true);
  view.setUint16(4, version, true);
  view.setUint16(6, kindFile, true);
  view.setUint32(56, 2, true);
  let at = headerBytes;
  for (const [type, part] of [[section.name, label], [section.bytes, content]] as const) {
    view.setUint32(at, type, true);
    view.setUint32(at + 8, part.length, true);
    view.setUint32(at + 12, part.length, true);
    new Uint8Array(bytes).set(part, at + sectionBytes);
    at += sectionBytes + padded(part.length);
  }
  return bytes;
}

export interface SceneEntry {
  name: string;
  title: string;
  description: string;
}

export interface Material {
  young: number;
  poisson: number;
  density: number;
}

export interface SceneFacts {
  number: number;
  name: string;
  title: string;
  elements: number;
  materials: Material[];
  gravity: number[];
  lo: number[];
  hi: number[];
  speed: number;
  notes: string[];
}

export interface Piece {
  id: number;
  volume: number;
  mass: number;
  held: boolean;
}

export interface Status {
  time: number;
  step: number;
  paused: boolean;
  state: 'running' | 'paused' | 'diverged';
  reason: string;
  speed: number;
  pace: number;
  real_time_factor: number;
  step_rate: number;
  tick_ms: number;
  cut_us: number;
  surface_us: number;
  nodes: number;
  elements: number;
  cut_elements: number;
  pieces: Piece[];
  piece_count: number;
  energies: { kinetic: number; elastic: number; gravity: number; damped: number };
  time_step: { used: number; bound: number; live_bound: number };
  strain: { stretch_min: number; stretch_max: number; inverted: number };
  strokes: number;
  materials: SceneFacts['materials'];
  gravity: [number, number, number];
  warnings: string[];
  clients: number;
}

/** What the engine says in texts: each has one of these. */
export interface EngineText {
  hello?: { protocol: number; version: string; driving: boolean; scenes: SceneEntry[] };
  driving?: { driving: boolean; clients: number };
  scene?: SceneFacts;
  loading?: { title: string };
  status?: Status;
  refused?: { id: number; message: string };
  notice?: { message: string };
  hash?: { id: number; hash: string; step: number };
  saved?: { id: number; path: string; file: string };
}

/** What the page asks for; an id is added on the way. */
export type Request =
  | { command: object }
  | { pause: boolean }
  | { step: number }
  | { speed: number }
  | { scene: string }
  | { reset: true }
  | { show: { stress: boolean; elements: boolean } }
  | { save: string }
  | { hash: true }
  | { drive: true };
