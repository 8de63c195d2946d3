/** Colours for further runs than those with a colour chosen by hand: each as distinct as possible from all before it. */

type Three = [number, number, number];

/** Oklab (Björn Ottosson): distances approximate perceived differences. */
function oklab(red: number, green: number, blue: number): Three {
  const linear = [red, green, blue].map((value) => {
    const part = value / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  const cone = (a: number, b: number, c: number) => Math.cbrt(a * linear[0] + b * linear[1] + c * linear[2]);
  const l = cone(0.4122214708, 0.5363325363, 0.0514459929);
  const m = cone(0.2119034982, 0.6806995451, 0.1073969566);
  const s = cone(0.0883024619, 0.2817188376, 0.6299787005);
  return [0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s, 1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s];
}

const hex = (rgb: Three) => `#${rgb.map((value) => value.toString(16).padStart(2, "0")).join("")}`;
const rgbOf = (text: string) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16)) as Three;

interface Candidate {
  colour: string;
  lab: Three;
  /** Distance to the nearest colour in use. */
  distance: number;
}

/** Colours that are readable on a light panel, or on a dark one. */
function candidates(dark: boolean): Candidate[] {
  const result: Candidate[] = [];
  for (let red = 0; red < 256; red += 15)
    for (let green = 0; green < 256; green += 15)
      for (let blue = 0; blue < 256; blue += 15) {
        const lab = oklab(red, green, blue);
        if (dark ? lab[0] < 0.62 || lab[0] > 0.93 : lab[0] < 0.36 || lab[0] > 0.7) continue;
        result.push({ colour: hex([red, green, blue]), lab, distance: Infinity });
      }
  return result;
}

const known = new Map<boolean, { left: Candidate[]; taken: string[] }>();

/** The colour of run `number`, after the `first` ones. */
export function furtherColour(number: number, dark: boolean, first: string[]): string {
  let palette = known.get(dark);
  if (!palette) known.set(dark, (palette = { left: candidates(dark), taken: [] }));
  const { left, taken } = palette;
  const take = (colour: string) => {
    taken.push(colour);
    const [l, a, b] = oklab(...rgbOf(colour));
    for (const each of left) each.distance = Math.min(each.distance, Math.hypot(each.lab[0] - l, each.lab[1] - a, each.lab[2] - b));
  };
  if (taken.length === 0) first.forEach(take);
  while (taken.length <= number) take(left.reduce((best, each) => (each.distance > best.distance ? each : best)).colour);
  return taken[number];
}
