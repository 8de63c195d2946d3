/** Files that the page saves. */

export function saveBlob(blob: Blob, name: string): void {
  const url = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** Saves columns of numbers that can be read back exactly; NaN is an empty field. */
export function saveCsv(names: string[], columns: ArrayLike<number | string | null | undefined>[], name: string): void {
  const quoted = (text: string) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const lines = [names.map(quoted).join(",")];
  const rows = Math.max(0, ...columns.map((column) => column.length));
  for (let i = 0; i < rows; ++i) {
    lines.push(
      columns
        .map((column) => column[i])
        .map((value) => (value === null || value === undefined || Number.isNaN(value) ? "" : quoted(String(value))))
        .join(","),
    );
  }
  saveBlob(new Blob([lines.join("\n") + "\n"], { type: "text/csv" }), name);
}

export function saveCanvas(canvas: HTMLCanvasElement, name: string): void {
  canvas.toBlob((blob) => blob && saveBlob(blob, name), "image/png");
}

/** Colour scale of a picture. */
export interface ColourKey {
  name: string;
  low: string;
  high: string;
  colours: string[];
}

/** Returns a picture below a title and a line of coloured names. */
export function withCaption(picture: HTMLCanvasElement, title: string, names: { text: string; colour: string }[],
                            background: string, foreground: string, bar?: ColourKey | null): HTMLCanvasElement {
  const scale = devicePixelRatio;
  const head = Math.round((names.length > 0 || bar ? 48 : 30) * scale);
  const canvas = document.createElement("canvas");
  canvas.width = picture.width;
  canvas.height = picture.height + head;
  const context = canvas.getContext("2d")!;
  context.fillStyle = background;
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = foreground;
  context.font = `600 ${14 * scale}px system-ui, sans-serif`;
  context.fillText(title, 10 * scale, 20 * scale);
  context.font = `${12 * scale}px system-ui, sans-serif`;
  let x = 10 * scale;
  for (const { text, colour } of names) {
    context.fillStyle = colour;
    context.fillRect(x, 32 * scale, 14 * scale, 4 * scale);
    context.fillStyle = foreground;
    context.fillText(text, x + 18 * scale, 39 * scale);
    x += 18 * scale + context.measureText(text).width + 16 * scale;
  }
  if (bar) {
    context.fillText(bar.low, x, 39 * scale);
    x += context.measureText(bar.low).width + 6 * scale;
    const width = (110 * scale) / bar.colours.length;
    for (const colour of bar.colours) {
      context.fillStyle = colour;
      context.fillRect(x, 30 * scale, Math.ceil(width), 9 * scale);
      x += width;
    }
    context.fillStyle = foreground;
    context.fillText(`${bar.high}  ${bar.name}`, x + 6 * scale, 39 * scale);
  }
  context.drawImage(picture, 0, head);
  return canvas;
}

/** File name of a title; letters and digits of any script are kept. */
export const fileName = (title: string) => title.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "") || "run";
