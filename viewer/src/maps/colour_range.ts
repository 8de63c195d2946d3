import { valueAt, type Levels } from "../data/decode";

/** The range that colours cover; values beyond have the last colour. */
export interface ColourRange {
  low: number;
  high: number;
  /** Some values lie above. */
  clipped: boolean;
  /** The largest value of all. */
  largest: number;
  /** Equal steps of colour are equal ratios; what is below `low` has the first colour. */
  logarithmic: boolean;
}

/** "automatic": all values, in a logarithmic scale where a few are many times as large as the others. */
export type ColourScale = "automatic" | "most" | "all" | "logarithmic";

/** A largest value so many times what 95 of 100 stay below would leave the others one colour. */
const farAbove = 3;

/** Where a value is between the first and the last colour. */
export function colourFraction(value: number, { low, high, logarithmic }: ColourRange): number {
  return logarithmic ? Math.log(Math.max(value, low) / low) / Math.log(high / low) : (value - low) / (high - low);
}

/** The value that a colour stands for. */
export function valueOfFraction(part: number, { low, high, logarithmic }: ColourRange): number {
  return logarithmic ? low * (high / low) ** part : low + part * (high - low);
}

/** Of several runs one range for all. */
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
 * With "most", from zero (or the least value) to what 99 of 100 values that are not zero stay below: a few peaks hide
 * nothing. With "all" up to the largest, at least to `reached`, which may be known from elsewhere.
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
      // Levels of a value that is zero are zero to half a step.
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

/** A sample may miss it. */
function largestOf({ levels, low, step, none }: Levels): number {
  let most = -1;
  for (const level of levels) if (level > most && level !== none) most = level;
  return most < 0 ? -Infinity : low + step * most;
}
