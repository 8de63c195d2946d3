import { valueAt, type Levels } from "../data/decode";

/** The range of the colours; values above it have the last colour. */
export interface ColourRange {
  low: number;
  high: number;
  /** Whether some values lie above `high`. */
  clipped: boolean;
  /** The largest value of all. */
  largest: number;
  /** Whether equal steps of colour are equal ratios; values below `low` then have the first colour. */
  logarithmic: boolean;
}

/** "automatic": all values, in a logarithmic scale if a few of them are many times as large as the others. */
export type ColourScale = "automatic" | "most" | "all" | "logarithmic";

/** Ratio of the largest value to the 95th percentile above which "automatic" is logarithmic. */
const farAbove = 3;

/** Fraction of a value between the first and the last colour. */
export function colourFraction(value: number, { low, high, logarithmic }: ColourRange): number {
  return logarithmic ? Math.log(Math.max(value, low) / low) / Math.log(high / low) : (value - low) / (high - low);
}

/** The value at a fraction between the first and the last colour. */
export function valueOfFraction(part: number, { low, high, logarithmic }: ColourRange): number {
  return logarithmic ? low * (high / low) ** part : low + part * (high - low);
}

/** One range for several runs. */
export function joinRanges(ranges: ColourRange[]): ColourRange | null {
  if (ranges.length === 0) return null;
  const logarithmic = ranges.some((range) => range.logarithmic);
  const positive = ranges.map(({ low }) => low).filter((low) => low > 0);
  const low = logarithmic ? Math.min(...positive) : Math.min(...ranges.map((range) => range.low));
  const high = Math.max(...ranges.map((range) => range.high));
  return { low: logarithmic && ranges.some((range) => range.low < 0) ? high / 1e4 : low, high, logarithmic,
    clipped: ranges.some((range) => range.clipped), largest: Math.max(...ranges.map((range) => range.largest)) };
}

/**
 * The range of the colours of these values. With "most", from zero (or the least value) to the 99th percentile of the
 * values that are not zero. With "all", up to the largest value and at least to `reached`, which may come from elsewhere.
 */
export function colourRange(arrays: Levels[], scale: ColourScale = "most", reached = 0): ColourRange {
  const sample: number[] = [];
  let low = Infinity;
  let high = -Infinity;
  for (const array of arrays) {
    const count = array.rows * array.columns;
    const step = Math.max(1, Math.floor(count / 50_000));
    for (let i = 0; i < count; i += step) {
      const value = valueAt(array, 0, i);
      if (Number.isNaN(value)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
      // The level of a zero value is zero up to half a step.
      if (Math.abs(value) > array.step) sample.push(value);
    }
  }
  if (!(low <= high)) return { low: 0, high: 1, clipped: false, largest: NaN, logarithmic: false };
  const largest = Math.max(high, ...arrays.map(largestOf), reached);
  if (low < 0) return { low, high: largest, clipped: false, largest, logarithmic: false };
  sample.sort((a, b) => a - b);
  const most = sample[Math.floor(0.99 * (sample.length - 1))] || largest || 1;
  if (scale === "most") return { low: 0, high: most, clipped: largest > 1.02 * most, largest, logarithmic: false };
  const common = sample[Math.floor(0.95 * (sample.length - 1))] || most;
  if (scale === "all" || (scale === "automatic" && !(largest > farAbove * common)))
    return { low: 0, high: largest > 0 ? largest : 1, clipped: false, largest, logarithmic: false };
  const middle = sample[Math.floor(0.5 * sample.length)] || most;
  const decades = Math.min(Math.max(Math.log10(largest / middle) + 0.7, 2), 3);
  return { low: largest / 10 ** decades, high: largest, clipped: false, largest, logarithmic: true };
}

/** The largest value of an array, which a sample may miss. */
function largestOf({ levels, low, step, none }: Levels): number {
  let most = -1;
  for (const level of levels) if (level > most && level !== none) most = level;
  return most < 0 ? -Infinity : low + step * most;
}
