import uPlot from "uplot";
import { axisStyle, axisWidth, tickTexts } from "../charts/axes";
import { chooseRange } from "../charts/scale";
import { runColour, themeColour } from "../colours";
import { valueAt } from "../data/decode";
import { indexAt, type Run } from "../data/run";
import { el } from "../elements";
import { fieldName, number, statusNames } from "../format";
import { fileName, saveCanvas, saveCsv, withCaption } from "../save";
import type { Store } from "../store";
import { colourRange } from "./colour_range";

interface Profile {
  run: Run;
  time: number;
  position: number[];
  values: number[];
}

/** A quantity along the contact boundary at the time of the cursor, of all visible runs in one plot. */
export class ProfileChart {
  readonly element: HTMLElement;
  private readonly plotArea = el("div.plot");
  private readonly title = el("h3");
  private readonly legend = el("div.legend");
  private plot: uPlot | null = null;
  private width = 0;
  /** Position of the pointer on the boundary. */
  private place: number | null = null;

  constructor(private readonly store: Store) {
    this.element = el("section.chart.panel", { id: "profile" },
      el("header", {}, this.title,
        el("div.tools", {},
          el("button.small", { type: "button", title: "Save the picture as PNG", onclick: () => this.savePicture() }, "PNG"),
          el("button.small", { type: "button", title: "Save the numbers as CSV", onclick: () => this.saveNumbers() }, "CSV"))),
      el("p.note", {}, "At the time of the cursor, over the position on the contact boundary."),
      this.plotArea, this.legend);
    for (const topic of ["runs", "theme", "contact"] as const) store.on(topic, () => this.rebuild());
    store.on("time", () => this.update());
    new ResizeObserver(() => {
      if (this.plotArea.clientWidth !== this.width) this.rebuild();
    }).observe(this.plotArea);
  }

  get profiles(): Profile[] {
    const result: Profile[] = [];
    for (const run of this.store.visibleRuns) {
      const contact = run.contact;
      const values = contact?.quantities.find(({ name }) => name === this.store.quantity)?.values;
      if (!contact || !values || contact.position.length === 0) continue;
      const frame = indexAt(contact.times, this.store.time);
      result.push({
        run,
        time: contact.times[frame],
        position: Array.from(contact.position),
        values: Array.from(contact.position, (_, node) => valueAt(values, frame, node)),
      });
    }
    return result;
  }

  private data(): uPlot.AlignedData {
    const profiles = this.profiles;
    const places = [...new Set(profiles.flatMap((p) => p.position))].sort((a, b) => a - b);
    const columns = profiles.map((p) => {
      const byPlace = new Map(p.position.map((s, i) => [s, p.values[i]]));
      return places.map((s) => byPlace.get(s));
    });
    return [places, ...columns] as uPlot.AlignedData;
  }

  rebuild(): void {
    this.plot?.destroy();
    this.plot = null;
    this.width = this.plotArea.clientWidth;
    const profiles = this.profiles;
    this.element.hidden = profiles.length === 0;
    if (this.width === 0 || profiles.length === 0) return;
    const extents = profiles.map(({ run }) => {
      const values = run.contact!.quantities.find(({ name }) => name === this.store.quantity)!.values;
      return { name: run.name, ...colourRange([values]) };
    });
    const isStatus = this.store.quantity === "contact_status";
    const { low, high } = isStatus ? { low: -0.2, high: 3.2 } : chooseRange(extents, "most");
    const axis = axisStyle();
    this.plot = new uPlot({
      width: this.width,
      height: this.width < 420 ? 190 : 230,
      legend: { show: false },
      scales: { x: { time: false }, y: { range: () => [low, high] } },
      series: [{}, ...profiles.map((p) => ({ stroke: runColour(p.run.number), width: 1.4, spanGaps: true,
        points: { show: true, size: 4 } }))],
      axes: [{ ...axis, label: "along the boundary", labelSize: 18, labelFont: "12px system-ui, sans-serif", size: 34, space: 80, values: tickTexts },
        { ...axis, size: isStatus ? 70 : axisWidth, values: (_, ticks) => ticks.map((tick) => (isStatus ? statusNames[tick + 1] ?? "" : number(tick, 6))) }],
      cursor: { y: false, drag: { x: false, y: false } },
      hooks: {
        setCursor: [({ cursor, posToVal }) => {
          const { left } = cursor;
          this.place = left !== undefined && left !== null && left >= 0 ? posToVal(left, "x") : null;
          this.showValues();
        }],
      },
    }, this.data(), this.plotArea);
    this.update();
  }

  private update(): void {
    if (!this.plot) return;
    this.plot.setData(this.data());
    this.title.textContent = `${capital(fieldName(this.store.quantity))} along the boundary`;
    this.showValues();
  }

  /** Shows the time of the frame, and with a pointer on the plot the value at the nearest node. */
  private showValues(): void {
    const isStatus = this.store.quantity === "contact_status";
    this.legend.replaceChildren(...this.profiles.map((p) => {
      const item = el("span.item", {}, el("i", { style: `background:${runColour(p.run.number)}` }), `${p.run.name} `);
      if (this.place !== null) {
        const distances = p.position.map((s) => Math.abs(s - this.place!));
        const node = distances.indexOf(Math.min(...distances));
        const value = isStatus ? statusNames[p.values[node] + 1] : number(p.values[node], 5);
        item.append(el("b", {}, value), ` at ${number(p.position[node], 4)}, `);
      }
      item.append(`t = ${number(p.time, 5)}`);
      return item;
    }));
  }

  private savePicture(): void {
    const canvas = this.plot?.root.querySelector("canvas");
    if (!canvas) return;
    const names = this.profiles.map((p) => ({ text: `${p.run.name}, t = ${number(p.time, 5)}`, colour: runColour(p.run.number) }));
    saveCanvas(withCaption(canvas, this.title.textContent ?? "", names, themeColour("panel"), themeColour("text")),
      `${fileName(this.title.textContent ?? "profile")}.png`);
  }

  private saveNumbers(): void {
    const profiles = this.profiles;
    saveCsv(profiles.flatMap((p) => [`${p.run.name}: place`, `${p.run.name}: ${this.store.quantity} at ${p.time}`]),
      profiles.flatMap((p) => [p.position, p.values]), `${fileName(this.title.textContent ?? "profile")}.csv`);
  }
}

export const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);
