// SPDX-License-Identifier: Apache-2.0
import { checkSurface, triangulate, type Surface } from './surface.ts';

type Numbers = Float32Array | Float64Array;

interface Tag {
  name: string;
  attributes: Map<string, string>;
  /** Text between this tag and the next one. */
  text: string;
}

interface File {
  bytes: Uint8Array;
  tags: Tag[];
  /** Where the byte counts of appended arrays start; -1 without appended data. */
  appendedAt: number;
  headerBytes: number;
}

const bytesOf: Record<string, number> = {
  Int8: 1, UInt8: 1, Int16: 2, UInt16: 2, Int32: 4, UInt32: 4, Int64: 8, UInt64: 8, Float32: 4, Float64: 8,
};

/** Reads VTK PolyData: appended raw or ascii arrays, little endian, one piece. */
export function readVtp(bytes: Uint8Array): Surface {
  const file = openFile(bytes);
  const points = readArray(file, findArray(file, 'Points', undefined));
  const restTag = findArray(file, 'PointData', 'rest', true);
  const rest = restTag ? readArray(file, restTag) : points;
  if (rest.length !== points.length) throw new Error(`'rest' holds ${rest.length} numbers, the points ${points.length}`);
  const connectivity = readArray(file, findArray(file, 'Polys', 'connectivity'));
  const offsets = readArray(file, findArray(file, 'Polys', 'offsets'));
  const faceTag = findArray(file, 'CellData', 'face', true);
  const face = faceTag ? readArray(file, faceTag) : undefined;
  const polygons: Numbers[] = [];
  let begin = 0;
  for (const end of offsets) {
    polygons.push(connectivity.subarray(begin, end));
    begin = end;
  }
  if (face && face.length < polygons.length) throw new Error(`'face' holds ${face.length} numbers for ${polygons.length} polygons`);
  return checkSurface({
    points: Float32Array.from(points),
    rest: Float32Array.from(rest),
    ...triangulate(polygons, face),
  });
}

function openFile(bytes: Uint8Array): File {
  // One character per byte, so that positions in the text are positions in the bytes.
  const start = new TextDecoder('latin1').decode(bytes);
  const appended = start.indexOf('<AppendedData');
  const tags = scanTags(appended < 0 ? start : start.slice(0, start.indexOf('>', appended) + 1));
  const root = tags.find((tag) => tag.name === 'VTKFile');
  if (!root || root.attributes.get('type') !== 'PolyData') throw new Error("it is not VTK PolyData; a .vtp starts with <VTKFile type=\"PolyData\">");
  if (root.attributes.get('byte_order') === 'BigEndian') throw new Error('it is big endian; write it little endian');
  if (root.attributes.has('compressor')) throw new Error('it is compressed; write it without compression');
  if (tags.filter((tag) => tag.name === 'Piece').length !== 1) throw new Error('it must hold exactly one <Piece>');
  const encoding = tags.find((tag) => tag.name === 'AppendedData')?.attributes.get('encoding');
  if (encoding !== undefined && encoding !== 'raw') throw new Error(`appended data in '${encoding}' is not read; write it raw`);
  return {
    bytes,
    tags,
    appendedAt: appended < 0 ? -1 : start.indexOf('_', start.indexOf('>', appended)) + 1,
    headerBytes: root.attributes.get('header_type') === 'UInt64' ? 8 : 4,
  };
}

function scanTags(text: string): Tag[] {
  const tags: Tag[] = [];
  for (const [, name, inside, after] of text.matchAll(/<([\/\w]+)([^>]*)>([^<]*)/g)) {
    const attributes = new Map<string, string>();
    for (const [, key, double, single] of inside.matchAll(/([\w]+)\s*=\s*(?:"([^"]*)"|'([^']*)')/g)) {
      attributes.set(key, double ?? single);
    }
    tags.push({ name, attributes, text: after });
  }
  return tags;
}

function findArray(file: File, section: string, name: string | undefined, optional: true): Tag | undefined;
function findArray(file: File, section: string, name: string | undefined): Tag;
function findArray(file: File, section: string, name: string | undefined, optional = false): Tag | undefined {
  const begin = file.tags.findIndex((tag) => tag.name === section);
  const end = file.tags.findIndex((tag) => tag.name === `/${section}`);
  const found = file.tags.slice(begin < 0 ? end : begin, end).find(
    (tag) => tag.name === 'DataArray' && (name === undefined || tag.attributes.get('Name') === name));
  if (!found && !optional) throw new Error(`<${section}> holds no array${name ? ` '${name}'` : ''}`);
  return found;
}

function readArray(file: File, tag: Tag): Numbers {
  const type = tag.attributes.get('type') ?? '';
  const format = tag.attributes.get('format') ?? 'ascii';
  if (!(type in bytesOf)) throw new Error(`numbers of type '${type}' are not read`);
  if (format === 'ascii') return Float64Array.from(tag.text.trim().split(/\s+/).filter(Boolean), Number);
  if (format !== 'appended') throw new Error(`arrays in format '${format}' are not read; write them appended raw or ascii`);
  if (file.appendedAt < 0) throw new Error('an array is appended, but there is no <AppendedData>');
  return readAppended(file, type, Number(tag.attributes.get('offset')));
}

function readAppended(file: File, type: string, offset: number): Numbers {
  const view = new DataView(file.bytes.buffer, file.bytes.byteOffset, file.bytes.byteLength);
  const at = file.appendedAt + offset;
  const begin = at + file.headerBytes;
  if (!(begin <= file.bytes.length)) throw new Error('the appended data ends too early; the file is cut short');
  const size = file.headerBytes === 8 ? Number(view.getBigUint64(at, true)) : view.getUint32(at, true);
  if (begin + size > file.bytes.length) throw new Error('the appended data ends too early; the file is cut short');
  if (size % bytesOf[type] !== 0) throw new Error(`an array of ${size} bytes does not hold whole ${type} numbers; the file is damaged`);
  // A copy starts at an aligned address, as typed arrays ask for.
  const copy = new Uint8Array(file.bytes.subarray(begin, begin + size)).buffer;
  switch (type) {
    case 'Float32': return new Float32Array(copy);
    case 'Float64': return new Float64Array(copy);
    case 'Int8': return Float64Array.from(new Int8Array(copy));
    case 'UInt8': return Float64Array.from(new Uint8Array(copy));
    case 'Int16': return Float64Array.from(new Int16Array(copy));
    case 'UInt16': return Float64Array.from(new Uint16Array(copy));
    case 'Int32': return Float64Array.from(new Int32Array(copy));
    case 'UInt32': return Float64Array.from(new Uint32Array(copy));
    case 'Int64': return Float64Array.from(new BigInt64Array(copy), Number);
    default: return Float64Array.from(new BigUint64Array(copy), Number);
  }
}
