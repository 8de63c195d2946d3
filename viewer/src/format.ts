/** Numbers and names as readable text. */

/** Text of a number; JSON has no infinity and no NaN, so these are null or words there. */
export function number(value: number | string | null, digits = 4): string {
  if (value === null) return "–";
  if (typeof value === "string") return value;
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "–" : value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e5 || size < 1e-3 ? value.toExponential(digits - 1) : value.toPrecision(digits);
  const [mantissa, exponent] = text.split("e");
  const short = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
  if (exponent === undefined) return short.replace("-", "−");
  return `${short}·10${superscript(Number(exponent))}`.replace("-", "−");
}

/** Converts the words and nulls of JSON to infinity and NaN. */
export function toNumber(value: number | string | null | undefined): number {
  if (typeof value === "number") return value;
  return value === "inf" ? Infinity : value === "-inf" ? -Infinity : NaN;
}

function superscript(exponent: number): string {
  const digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  return (exponent < 0 ? "⁻" : "") + [...String(Math.abs(exponent))].map((digit) => digits[Number(digit)]).join("");
}

type Sides = { group: string; against?: string };
/** The two groups of each contact between bodies, by its number. */
const pairs = new Map<number, string>();

/** Names the contacts between bodies, from those of all runs; a number whose groups differ between runs stays a number. */
export function namePairs(contactsOfRuns: Sides[][]): void {
  pairs.clear();
  contactsOfRuns[0]?.forEach(({ group, against }, number) => {
    const same = contactsOfRuns.every((contacts) => contacts[number]?.group === group && contacts[number]?.against === against);
    if (against !== undefined && same) pairs.set(number, `${group} and ${against}`);
  });
}

/** "total_energy" → "total energy", "lowest.reaction_normal" → "lowest: normal reaction". */
export function columnName(column: string): string {
  const known: Record<string, string> = {
    "@force": "largest component",
    reaction_normal: "normal reaction",
    active_contacts: "active",
    max_penetration: "deepest interpenetration",
    max_rotation: "largest rotation",
    load_potential: "load potential",
  };
  const pair = /^pair_force\.(\d+)_([xyz])$/.exec(column);
  if (pair) return `between ${pairs.get(Number(pair[1])) ?? `bodies, contact ${pair[1]}`}, ${pair[2]}`;
  const at = column.indexOf(".");
  const probe = at < 0 ? "" : column.slice(0, at);
  const rest = at < 0 ? column : column.slice(at + 1);
  const words = known[rest] ?? rest.replace(/_([xyz])$/, " $1").replaceAll("_", " ");
  return probe ? `${probe}: ${words}` : words;
}

export function fieldName(field: string): string {
  const known: Record<string, string> = {
    von_mises: "von Mises stress",
    velocity: "speed",
    displacement: "displacement magnitude",
    displacement_x: "displacement x",
    displacement_y: "displacement y",
    displacement_z: "displacement z",
    contact_status: "contact status",
    "": "none",
  };
  return known[field] ?? field.replaceAll("_", " ");
}

export const statusNames = ["off the boundary", "open", "closed", "sticks", "slips"];

export function seconds(value: number): string {
  if (value >= 120) return `${Math.floor(value / 60)} min ${Math.round(value % 60)} s`;
  return value >= 1 ? `${value.toFixed(1)} s` : value >= 1e-3 ? `${(1e3 * value).toFixed(1)} ms` : `${number(1e6 * value, 3)} µs`;
}

export function count(value: number): string {
  return value.toLocaleString("en").replaceAll(",", "\u202f");
}
