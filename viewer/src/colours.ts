/** Colours of runs, of fields and of contact. */
import { furtherColour } from "./palette";

// The colours of Okabe and Ito, distinct for any kind of colour vision; the third is darker, to be readable on white.
const runsLight = ["#c8460a", "#0068b0", "#00785a", "#a8519a", "#8a6d00", "#2a8fbf", "#6b4c9a", "#5b5b5b"];
const runsDark = ["#ff8a4c", "#5cb3ff", "#3fd6a5", "#e08ad0", "#e6c229", "#8fd6f5", "#b79cf0", "#bdbdbd"];

const root = document.documentElement;
let chosen = false;

export const isDark = (): boolean => root.dataset.theme === "dark";

/** Follows the theme of the system until the reader chooses one. */
export function followSystem(changed: () => void): void {
  const system = matchMedia("(prefers-color-scheme: dark)");
  const follow = () => {
    if (chosen) return;
    root.dataset.theme = system.matches ? "dark" : "light";
    changed();
  };
  system.addEventListener("change", follow);
  follow();
}

export function toggleTheme(): void {
  chosen = true;
  root.dataset.theme = isDark() ? "light" : "dark";
}

export function runColour(run: number): string {
  const colours = isDark() ? runsDark : runsLight;
  return run < colours.length ? colours[run] : furtherColour(run, isDark(), colours);
}

/** A colour of the style sheet. */
export function themeColour(name: string): string {
  return getComputedStyle(root).getPropertyValue(`--${name}`).trim();
}

type Rgb = [number, number, number];

const parse = (hex: string): Rgb => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)) as Rgb;

// Viridis at nine equidistant points.
const viridis = ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"].map(parse);

/** 256 colours from the least to the largest value. */
export const fieldColours: Uint8Array = (() => {
  const table = new Uint8Array(4 * 256);
  for (let i = 0; i < 256; ++i) {
    const at = (i / 255) * (viridis.length - 1);
    const k = Math.min(Math.floor(at), viridis.length - 2);
    for (let c = 0; c < 3; ++c)
      table[4 * i + c] = Math.round(viridis[k][c] + (at - k) * (viridis[k + 1][c] - viridis[k][c]));
    table[4 * i + 3] = 255;
  }
  return table;
})();

// By contact_status + 1: off the boundary, open, closed without friction, sticks, slips.
const statusHex = { light: ["#d4d4d4", "#c2c9d1", "#00785a", "#0068b0", "#e0711a"], dark: ["#4a4a4a", "#4b545e", "#3fd6a5", "#5cb3ff", "#ff9d4c"] };

export function statusColour(status: number): string {
  return statusHex[isDark() ? "dark" : "light"][Math.min(Math.max(Math.round(status) + 1, 0) || 0, 4)];
}

export const statusRgb = (status: number): Rgb => parse(statusColour(status));

export function fieldCss(fraction: number): string {
  const at = 4 * Math.round(255 * Math.min(Math.max(fraction, 0), 1));
  return `rgb(${fieldColours[at]} ${fieldColours[at + 1]} ${fieldColours[at + 2]})`;
}
