/** Joins curves with times of their own into a table for uPlot: one ascending list of times, a column for each curve. */

export interface Curve {
  times: Float64Array;
  values: Float64Array;
}

export type Table = { times: Float64Array; columns: (Float64Array | (number | null | undefined)[])[] };

const equal = (a: Float64Array, b: Float64Array) =>
  a === b || (a.length === b.length && a.every((value, i) => value === b[i]));

export function joined(curves: Curve[]): Table {
  const times = curves[0]?.times ?? new Float64Array(0);
  if (curves.every((curve) => equal(curve.times, times))) return { times, columns: curves.map((c) => c.values) };
  // Distinct lists of times are merged; a time that occurs twice in a list is kept twice.
  const lists = [...new Set(curves.map((curve) => curve.times))];
  const all = new Float64Array(lists.reduce((sum, list) => sum + list.length, 0));
  let at = 0;
  for (const list of lists) {
    all.set(list, at);
    at += list.length;
  }
  all.sort();
  const merged: number[] = [];
  for (let i = 0; i < all.length; ) {
    let end = i;
    while (end < all.length && all[end] === all[i]) ++end;
    const needed = end - i === 1 ? 1 : Math.max(...lists.map((list) => occurrences(list, all[i])));
    for (let k = 0; k < needed; ++k) merged.push(all[i]);
    i = end;
  }
  const columns = curves.map(({ times: own, values }) => {
    const column: (number | null | undefined)[] = new Array(merged.length).fill(undefined);
    let next = 0;
    for (let i = 0; i < merged.length && next < own.length; ++i) {
      if (merged[i] === own[next]) column[i] = values[next++];
    }
    return column;
  });
  return { times: Float64Array.from(merged), columns };
}

function lowerBound(list: Float64Array, value: number): number {
  let low = 0;
  let high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

function occurrences(list: Float64Array, value: number): number {
  const first = lowerBound(list, value);
  let end = first;
  while (end < list.length && list[end] === value) ++end;
  return end - first;
}
