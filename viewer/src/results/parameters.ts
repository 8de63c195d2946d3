import type { Run } from "../data/run";

/** Entries of the case in which runs differ. */
export interface Parameter {
  name: string;
  /** Value of each run as written in the case; "–" if the run does not have the entry. */
  texts: string[];
  /** The values as numbers; null if some are not numbers. */
  numbers: number[] | null;
}

/** Entries that do not change results. */
const idle = /^(expect|output|check|title$|probe\.|solver\.)/;

/** Entries of the case; components of vectors are entries of their own: "initial.velocity y". */
function entries(run: Run): Map<string, string> {
  const result = new Map<string, string>();
  for (const [key, value] of Object.entries(run.summary.parameters)) {
    if (idle.test(key)) continue;
    const parts = /^\[(.*)\]$/.exec(value)?.[1].split(",").map((part) => part.trim());
    if (parts && parts.length >= 2 && parts.length <= 3) parts.forEach((part, k) => result.set(`${key} ${"xyz"[k]}`, part));
    else result.set(key, value);
  }
  return result;
}

/** Entries in which the runs differ: numbers first, and those with most values first. */
export function differingParameters(runs: Run[]): Parameter[] {
  const all = runs.map(entries);
  const names = [...new Set(all.flatMap((each) => [...each.keys()]))];
  const result: Parameter[] = [];
  for (const name of names) {
    const texts = all.map((each) => each.get(name) ?? "–");
    if (new Set(texts).size < 2) continue;
    const numbers = texts.map((text) => (/^[-+]?[\d.]/.test(text) ? Number(text) : NaN));
    result.push({ name, texts, numbers: numbers.every(Number.isFinite) ? numbers : null });
  }
  const values = (each: Parameter) => new Set(each.texts).size;
  return result.sort((a, b) => Number(b.numbers !== null) - Number(a.numbers !== null) || values(b) - values(a));
}
