import type { PackedArray } from "./types";

/** Decodes the arrays that src/ricochet/report/packed_array.cpp encodes. */

/** Levels, with the parameters that convert them to values. */
export interface Levels {
  rows: number;
  columns: number;
  levels: Uint8Array | Uint16Array;
  low: number;
  step: number;
  /** The level of "no number". */
  none: number;
}

export function valueAt(array: Levels, row: number, column: number): number {
  const level = array.levels[row * array.columns + column];
  return level === array.none ? NaN : array.low + array.step * level;
}

export async function inflated(base64: string): Promise<Uint8Array> {
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Decodes doubles: each xor the previous one, stored by byte planes. */
export function reals(bytes: Uint8Array): Float64Array {
  const count = bytes.length / 8;
  const result = new Float64Array(count);
  const raw = new Uint8Array(result.buffer); // typed arrays are little-endian in every browser
  for (let k = 0; k < 8; ++k) {
    let before = 0;
    for (let i = 0; i < count; ++i) {
      before ^= bytes[k * count + i];
      raw[8 * i + k] = before;
    }
  }
  return result;
}

/** Decodes 32-bit integers: zigzag codes of differences, stored by byte planes. */
export function indices(bytes: Uint8Array): Int32Array {
  const count = bytes.length / 4;
  const result = new Int32Array(count);
  let before = 0;
  for (let i = 0; i < count; ++i) {
    const code =
      (bytes[i] | (bytes[count + i] << 8) | (bytes[2 * count + i] << 16) | (bytes[3 * count + i] << 24)) >>> 0;
    const difference = (code & 1) !== 0 ? ~(code >>> 1) : code >>> 1;
    before = (before + difference) | 0;
    result[i] = before;
  }
  return result;
}

export function levels(bytes: Uint8Array, array: PackedArray): Levels {
  const { rows, columns } = array;
  const bits = array.bits ?? 16;
  const mask = (1 << bits) - 1;
  const result = bits > 8 ? new Uint16Array(rows * columns) : new Uint8Array(rows * columns);
  const planes = bits > 8 ? 2 : 1;
  for (let r = 0; r < rows; ++r) {
    const from = planes * r * columns;
    const to = r * columns;
    for (let i = 0; i < columns; ++i) {
      let expected = r > 0 ? result[to - columns + i] : 0;
      if (i > 0 && (r === 0 || array.prediction === 2))
        expected += result[to + i - 1] - (r > 0 ? result[to - columns + i - 1] : 0);
      let code = bytes[from + i];
      if (planes === 2) code |= bytes[from + columns + i] << 8;
      const difference = (code & 1) !== 0 ? ~(code >> 1) : code >> 1;
      result[to + i] = (expected + difference) & mask;
    }
  }
  return { rows, columns, levels: result, low: array.low ?? 0, step: array.step ?? 1, none: mask };
}
