import { fieldColours, statusRgb, themeColour } from "../colours";
import { valueAt, type Levels } from "../data/decode";
import { indexAt, type Run } from "../data/run";
import { el } from "../elements";
import { fieldName, number, statusNames } from "../format";
import { fileName, saveCanvas, saveCsv, withCaption } from "../save";
import type { Store } from "../store";
import { colourBar, colourKey } from "./colour_bar";
import { colourRange, type ColourRange } from "./colour_range";

const margin = { left: 66, right: 8, top: 6, bottom: 24 };

/** Map of a quantity on the contact boundary of one run: time to the right, position on the boundary upwards. */
export class ContactMap {
  readonly element: HTMLElement;
  private readonly canvas = el("canvas", { tabIndex: 0, role: "img" });
  private readonly cursor = el("div.cursor");
  private readonly tip = el("div.tip", { hidden: true });
  private readonly colours = el("div");
  private readonly area: HTMLElement;
  private range: ColourRange | null = null;
  /** The node of each row of pixels, −1 between pieces. */
  private rowNodes = new Int32Array(0);

  constructor(
    private readonly store: Store,
    readonly run: Run,
  ) {
    this.area = el("div.map-area", {}, this.canvas, this.cursor, this.tip);
    this.element = el("div.map", {}, this.area, this.colours,
      el("div.tools", {},
        el("button.small", { type: "button", title: "Save the picture as PNG", onclick: () => this.savePicture() }, "PNG"),
        el("button.small", { type: "button", title: "Save the numbers as CSV", onclick: () => this.saveNumbers() }, "CSV")));
    for (const topic of ["contact", "zoom", "theme", "runs"] as const) store.on(topic, () => this.draw());
    store.on("time", () => this.showTime());
    this.canvas.addEventListener("pointermove", (event) => this.pointed(event));
    this.canvas.addEventListener("pointerdown", (event) => this.pointed(event, true));
    this.canvas.addEventListener("pointerleave", () => (this.tip.hidden = true));
    new ResizeObserver(() => this.draw()).observe(this.area);
  }

  private get values(): Levels | null {
    return this.run.contact?.quantities.find(({ name }) => name === this.store.quantity)?.values ?? null;
  }
  private get isStatus(): boolean {
    return this.store.quantity === "contact_status";
  }
  private get times(): [number, number] {
    return this.store.zoom ?? [this.store.start, this.store.end];
  }

  /** Value drawn at fractions of the width and height of the map. */
  valueAtFraction(x: number, y: number): number {
    const contact = this.run.contact;
    const values = this.values;
    if (!contact || !values) return NaN;
    const [start, end] = this.times;
    const frame = this.frameAt(start + x * (end - start));
    if (frame < 0) return NaN;
    const node = this.rowNodes[Math.min(Math.floor(y * this.rowNodes.length), this.rowNodes.length - 1)];
    return node < 0 ? NaN : valueAt(values, frame, node);
  }

  draw(): void {
    const contact = this.run.contact;
    const values = this.values;
    const width = this.area.clientWidth;
    if (!contact || width === 0) return;
    const scale = devicePixelRatio;
    const height = 170;
    this.canvas.style.height = `${height}px`;
    this.canvas.width = Math.round(width * scale);
    this.canvas.height = Math.round(height * scale);
    const context = this.canvas.getContext("2d")!;
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, width, height);
    this.canvas.setAttribute("aria-label", `${fieldName(this.store.quantity)} of ${this.run.name} over time and position`);
    const inner = { width: width - margin.left - margin.right, height: height - margin.top - margin.bottom };
    if (!values) {
      context.fillStyle = themeColour("muted");
      context.font = "12px system-ui, sans-serif";
      context.fillText("This run did not write the field.", margin.left, 40);
      this.colours.replaceChildren();
      return;
    }
    const shared = this.store.visibleRuns.flatMap(
      (run) => run.contact?.quantities.filter(({ name }) => name === this.store.quantity).map((q) => q.values) ?? [],
    );
    this.range = this.isStatus ? null : colourRange(this.store.sharedColours ? shared : [values]);
    const pixels = this.picture(values, Math.max(1, Math.round(inner.width * scale)), Math.max(1, Math.round(inner.height * scale)));
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.putImageData(pixels, Math.round(margin.left * scale), Math.round(margin.top * scale));
    context.setTransform(scale, 0, 0, scale, 0, 0);
    this.drawAxes(context, inner);
    const present = [0, 1, 2, 3].filter((status) => values.levels.includes(status + 1));
    this.colours.replaceChildren(colourBar(fieldName(this.store.quantity), this.range, present));
    this.showTime();
  }

  /** The frame nearest to a time; −1 after the end of the run. */
  private frameAt(time: number): number {
    const { times } = this.run.contact!;
    const last = times.length - 1;
    const frame = indexAt(times, time);
    return frame === last && time > times[last] + (times[last] - times[Math.max(last - 1, 0)]) ? -1 : frame;
  }

  private picture(values: Levels, width: number, height: number): ImageData {
    const { position, pieces } = this.run.contact!;
    const [start, end] = this.times;
    const frames = Int32Array.from({ length: width }, (_, x) => {
      const time = start + ((x + 0.5) / width) * (end - start);
      return this.frameAt(time);
    });
    const whole = position[position.length - 1];
    this.rowNodes = Int32Array.from({ length: height }, (_, y) => {
      const at = (1 - (y + 0.5) / height) * whole;
      const node = indexAt(position, at);
      const piece = pieces.filter((first) => first <= node).length - 1;
      const last = (pieces[piece + 1] ?? position.length) - 1;
      const gap = 0.02 * whole;
      return at > position[last] + gap / 10 || at < position[pieces[piece]] - gap / 10 ? -1 : node;
    });
    const image = new ImageData(width, height);
    const data = image.data;
    const none = Number.parseInt(themeColour("panel").slice(1, 3), 16);
    const colours = [-1, 0, 1, 2, 3].map(statusRgb);
    const { low, high } = this.range ?? { low: 0, high: 1 };
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        const at = 4 * (y * width + x);
        const value = this.rowNodes[y] < 0 || frames[x] < 0 ? NaN : valueAt(values, frames[x], this.rowNodes[y]);
        data[at + 3] = 255;
        if (Number.isNaN(value)) {
          data[at] = data[at + 1] = data[at + 2] = none;
        } else if (this.isStatus) {
          const colour = colours[Math.round(value) + 1] ?? colours[0];
          data[at] = colour[0];
          data[at + 1] = colour[1];
          data[at + 2] = colour[2];
        } else {
          const k = 4 * Math.round(255 * Math.min(Math.max((value - low) / (high - low), 0), 1));
          data[at] = fieldColours[k];
          data[at + 1] = fieldColours[k + 1];
          data[at + 2] = fieldColours[k + 2];
        }
      }
    }
    return image;
  }

  private drawAxes(context: CanvasRenderingContext2D, inner: { width: number; height: number }): void {
    const { position } = this.run.contact!;
    const whole = position[position.length - 1];
    const [start, end] = this.times;
    context.fillStyle = themeColour("muted");
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const part of [0, 0.5, 1]) {
      const y = margin.top + (1 - part) * inner.height;
      context.fillText(number(part * whole, 3), margin.left - 5, Math.min(Math.max(y, 8), margin.top + inner.height - 5));
    }
    context.textBaseline = "top";
    for (const part of [0, 0.5, 1]) {
      context.textAlign = part === 0 ? "left" : part === 1 ? "right" : "center";
      context.fillText(`${part === 0.5 ? "time " : ""}${number(start + part * (end - start), 3)}`,
        margin.left + part * inner.width, margin.top + inner.height + 6);
    }
    context.save();
    context.translate(9, margin.top + inner.height / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText("along the boundary", 0, -8);
    context.restore();
  }

  private showTime(): void {
    const [start, end] = this.times;
    const inner = this.area.clientWidth - margin.left - margin.right;
    const part = (this.store.time - start) / (end - start);
    this.cursor.hidden = !(part >= 0 && part <= 1) || !this.values;
    this.cursor.style.left = `${margin.left + part * inner}px`;
  }

  private pointed(event: PointerEvent, pressed = false): void {
    const values = this.values;
    const box = this.canvas.getBoundingClientRect();
    const x = (event.clientX - box.left - margin.left) / (box.width - margin.left - margin.right);
    const y = (event.clientY - box.top - margin.top) / (box.height - margin.top - margin.bottom);
    if (!values || x < 0 || x > 1 || y < 0 || y >= 1) {
      this.tip.hidden = true;
      return;
    }
    const [start, end] = this.times;
    if (!this.store.playing || pressed) this.store.setTime(start + x * (end - start), this);
    const value = this.valueAtFraction(x, y);
    const node = this.rowNodes[Math.min(Math.floor(y * this.rowNodes.length), this.rowNodes.length - 1)];
    this.tip.hidden = node < 0 || Number.isNaN(value);
    if (this.tip.hidden) return;
    const text = this.isStatus ? statusNames[Math.round(value) + 1] : number(value, 4);
    this.tip.textContent = `${fieldName(this.store.quantity)} ${text} at ${number(this.run.contact!.position[node], 4)}`;
    this.tip.style.left = `${Math.min(event.clientX - box.left + 12, box.width - 190)}px`;
    this.tip.style.top = `${event.clientY - box.top + 12}px`;
  }

  private savePicture(): void {
    saveCanvas(withCaption(this.canvas, `${fieldName(this.store.quantity)}, ${this.run.name}`, [], themeColour("panel"), themeColour("text"), colourKey(fieldName(this.store.quantity), this.range)),
      `${fileName(this.run.name)}-${fileName(this.store.quantity)}.png`);
  }

  /** Saves a row for each frame and a column for each node, named by its position. */
  private saveNumbers(): void {
    const values = this.values;
    const contact = this.run.contact;
    if (!values || !contact) return;
    const columns = Array.from(contact.position, (_, node) => contact.times.map((_, frame) => valueAt(values, frame, node)));
    saveCsv(["time", ...Array.from(contact.position, String)], [contact.times, ...columns],
      `${fileName(this.run.name)}-${fileName(this.store.quantity)}.csv`);
  }
}
