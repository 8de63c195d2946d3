import type uPlot from "uplot";
import { number } from "../format";

/** Numbers at the ticks of an axis, of any size. */
export const tickTexts = (_: uPlot, ticks: (number | null)[]): string[] =>
  ticks.map((tick) => (tick === null ? "" : number(tick, 6)));

/** Of an upright axis: wide enough for its numbers. */
export const axisWidth = (_: uPlot, texts: string[] | null): number =>
  Math.max(50, 22 + 6.8 * Math.max(...(texts ?? []).map((text) => text?.length ?? 0)));
