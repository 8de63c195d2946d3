/** The range of values that a chart shows. */

export type ScaleMode = "most" | "all" | "logarithmic";

export interface Extent {
  name: string;
  low: number;
  high: number;
}

export interface Range {
  low: number;
  high: number;
  /** The extents that exceed the chart. */
  outside: Extent[];
}

/** A run is left out if it reaches farther than this many times the median. */
const outlying = 8;

/**
 * Chooses the range of a chart. With "most", runs whose values reach many times as far as those of the others are left
 * out: the chart shows the others, zero, and as much again. Values below `small` are no scale for the others.
 */
export function chooseRange(extents: Extent[], mode: ScaleMode, small = 0): Range {
  const finite = extents.filter((e) => e.low <= e.high);
  if (finite.length === 0) return { low: 0, high: 1, outside: [] };
  const reach = (e: Extent) => Math.max(Math.abs(e.low), Math.abs(e.high));
  const reaches = finite.map(reach).sort((a, b) => a - b);
  let inside = finite;
  if (mode === "most") {
    const middle = Math.max(reaches[Math.floor((reaches.length - 1) / 2)], small);
    if (middle > 0) inside = finite.filter((e) => reach(e) <= outlying * middle);
  }
  let low = Math.min(...inside.map((e) => e.low));
  let high = Math.max(...inside.map((e) => e.high));
  const outside = finite.filter((e) => !inside.includes(e));
  if (outside.length > 0) {
    const all = Math.max(high, 0) - Math.min(low, 0);
    const room = all > 0 ? all : 1;
    if (outside.some((e) => e.high > high)) high = Math.max(high, 0) + room;
    if (outside.some((e) => e.low < low)) low = Math.min(low, 0) - room;
    low = Math.min(low, 0);
    high = Math.max(high, 0);
  }
  if (low === high) {
    const margin = low === 0 ? 1 : 0.1 * Math.abs(low);
    return { low: low - margin, high: high + margin, outside };
  }
  const margin = 0.05 * (high - low);
  return { low: low - margin, high: high + margin, outside };
}

export function extentOf(name: string, values: ArrayLike<number>): Extent {
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0; i < values.length; ++i) {
    const value = values[i];
    if (!Number.isFinite(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return { name, low, high };
}

/** Whole decades around all positive values, at most sixteen. */
export function logarithmicRange(columns: ArrayLike<number>[]): [number, number] {
  let low = Infinity;
  let high = 0;
  for (const values of columns) {
    for (let i = 0; i < values.length; ++i) {
      const value = values[i];
      if (!(value > 0) || value === Infinity) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (high === 0) return [1, 10];
  const top = Math.ceil(Math.log10(high) + 1e-9);
  const bottom = Math.max(Math.floor(Math.log10(low)), top - 16, -307);
  return [10 ** bottom, 10 ** Math.max(top, bottom + 1)];
}

/** Powers of ten for the ticks, at most six. */
export function powersOfTen([low, high]: [number, number]): number[] {
  const [first, last] = [Math.round(Math.log10(low)), Math.round(Math.log10(high))];
  const step = Math.max(1, Math.ceil((last - first) / 5));
  const result: number[] = [];
  for (let power = first; power <= last; power += step) result.push(10 ** power);
  return result;
}
