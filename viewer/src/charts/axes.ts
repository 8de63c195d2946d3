import type uPlot from "uplot";
import { themeColour } from "../colours";
import { number } from "../format";

/** Texts at the ticks of an axis, for numbers of any magnitude. */
export const tickTexts = (_: uPlot, ticks: (number | null)[]): string[] =>
  ticks.map((tick) => (tick === null ? "" : number(tick, 6)));

/** Width of a vertical axis for its numbers. */
export const axisWidth = (_: uPlot, texts: string[] | null): number =>
  Math.max(50, 22 + 6.8 * Math.max(...(texts ?? []).map((text) => text?.length ?? 0)));

/** Style of all axes, in the colours of the theme. */
export const axisStyle = (): uPlot.Axis => ({
  stroke: themeColour("muted"),
  grid: { stroke: themeColour("grid"), width: 1 },
  ticks: { stroke: themeColour("grid"), width: 1 },
  font: "12px system-ui, sans-serif",
});
