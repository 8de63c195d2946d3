import { fieldCss, statusColour } from "../colours";
import { el } from "../elements";
import { number, statusNames } from "../format";
import type { ColourKey } from "../save";
import { valueOfFraction, type ColourRange } from "./colour_range";

/** Legend of the colours: a bar with its range, or the names of the contact statuses. */
export function colourBar(name: string, range: ColourRange | null, statuses: number[] = [0, 1, 2, 3]): HTMLElement {
  if (!range) {
    return el("div.colour-names", {}, ...statuses.map((status) =>
      el("span.item", {}, el("i", { style: `background:${statusColour(status)}` }), statusNames[status + 1])));
  }
  const stops = Array.from({ length: 9 }, (_, i) => fieldCss(i / 8)).join(",");
  const middle = range.logarithmic ? ` … ${number(valueOfFraction(0.5, range), 2)} …` : "";
  return el("div.colour-bar", {},
    el("span", {}, `${range.logarithmic ? "≤ " : ""}${number(range.low, 3)}${middle}`),
    el("i", { style: `background:linear-gradient(90deg,${stops})` }),
    el("span", {}, highest(range)),
    el("span.muted", {}, `${name}${range.logarithmic ? ", logarithmic" : ""}`));
}

const highest = (range: ColourRange) =>
  range.clipped ? `≥ ${number(range.high, 3)}, up to ${number(range.largest, 3)}` : number(range.high, 3);

/** Legend for a saved picture. */
export function colourKey(name: string, range: ColourRange | null): ColourKey {
  if (!range) return { name: statusNames.slice(1).join(", "), low: "", high: "", colours: [0, 1, 2, 3].map(statusColour) };
  return { name: `${name}${range.logarithmic ? ", logarithmic" : ""}`, low: number(range.low, 3), high: highest(range), colours: Array.from({ length: 64 }, (_, i) => fieldCss(i / 63)) };
}
