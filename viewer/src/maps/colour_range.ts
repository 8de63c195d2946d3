import { valueAt, type Levels } from "../data/decode";

/** The range that colours cover; values beyond have the last colour. */
export interface ColourRange {
  low: number;
  high: number;
  /** Some values lie above. */
  clipped: boolean;
}

/** From zero (or the least value) to what 99 of 100 values that are not zero stay below: a few peaks hide nothing. */
export function colourRange(arrays: Levels[]): ColourRange {
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
  if (!(low <= high)) return { low: 0, high: 1, clipped: false };
  if (low < 0) return { low, high, clipped: false };
  sample.sort((a, b) => a - b);
  const most = sample[Math.floor(0.99 * (sample.length - 1))] ?? 1;
  return { low: 0, high: most > 0 ? most : 1, clipped: high > 1.02 * most };
}
