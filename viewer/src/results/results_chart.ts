import uPlot from "uplot";
import { axisStyle, axisWidth, tickTexts } from "../charts/axes";
import { logarithmicRange, powersOfTen } from "../charts/scale";
import { runColour, themeColour } from "../colours";
import type { Run } from "../data/run";
import { el, select } from "../elements";
import { number } from "../format";
import { fileName, saveCanvas, saveCsv, withCaption } from "../save";
import type { Store } from "../store";
import { differingParameters, type Parameter } from "./parameters";
import { quantities, type Quantity } from "./quantities";

interface Point {
  run: Run;
  x: number;
  y: number;
}

/** Runs that differ only in the entry on the abscissa. */
interface Line {
  name: string;
  points: Point[];
}

/** "run": a bar for each run. */
const byRun = "run";

/** A result of each run against an entry that varies between the runs: points and lines over numbers, bars otherwise. */
export class ResultsChart {
  readonly element: HTMLElement;
  /** Whether a number varies, with more than two values. */
  readonly isTrend: boolean;
  readonly parameters: Parameter[];
  private readonly all: Quantity[];
  private quantity: Quantity;
  private against: string;
  private logarithmic = false;
  private readonly plotArea = el("div.plot");
  private readonly tip = el("div.tip", { hidden: true });
  private readonly without = el("p.note");
  private plot: uPlot | null = null;
  private width = 0;

  constructor(private readonly store: Store, private readonly runs: Run[]) {
    this.parameters = differingParameters(runs);
    this.all = quantities(runs);
    this.quantity = this.all[0];
    const first = this.parameters[0];
    this.isTrend = first !== undefined && first.numbers !== null && new Set(first.numbers).size > 2;
    this.against = this.isTrend ? first.name : byRun;
    const what = select("result", this.all.map(({ id, title }) => [id, title]), this.quantity.id, (id) => this.show(id, this.against));
    what.control.id = "result";
    const over = select("against", [[byRun, "run"], ...this.parameters.map(({ name }): [string, string] => [name, name])], this.against,
      (name) => this.show(this.quantity.id, name));
    over.control.id = "against";
    const log = el("button.small", { type: "button", "aria-pressed": "false", onclick: () => {
      this.logarithmic = !this.logarithmic;
      log.setAttribute("aria-pressed", String(this.logarithmic));
      this.rebuild();
    } }, "logarithmic");
    this.element = el("section.chart.panel", { id: "results" },
      el("header", {}, el("h3", {}, "Results of the runs"),
        el("div.tools", {}, what.element, over.element, log,
          el("button.small", { type: "button", title: "Save the picture as PNG", onclick: () => this.savePicture() }, "PNG"),
          el("button.small", { type: "button", title: "Save the numbers as CSV", onclick: () => this.saveNumbers() }, "CSV"))),
      el("div.results-area", {}, this.plotArea, this.tip), this.without);
    for (const topic of ["runs", "theme", "highlight"] as const) store.on(topic, () => this.rebuild());
    this.plotArea.addEventListener("pointermove", (event) => this.pointed(event));
    this.plotArea.addEventListener("pointerleave", () => {
      this.tip.hidden = true;
      store.setHighlight(null);
    });
    this.plotArea.addEventListener("click", (event) => {
      const near = this.nearest(event);
      if (near) store.toggle(near.run.number);
    });
    new ResizeObserver(() => {
      if (this.plotArea.clientWidth !== this.width) this.rebuild();
    }).observe(this.plotArea);
  }

  show(quantity: string, against: string): void {
    this.quantity = this.all.find(({ id }) => id === quantity) ?? this.all[0];
    this.against = against;
    this.rebuild();
  }

  private get parameter(): Parameter | undefined {
    return this.parameters.find(({ name }) => name === this.against);
  }

  /** Texts on the abscissa if it has no numbers: names of runs, or values of an entry. */
  private get categories(): string[] | null {
    if (this.parameter?.numbers) return null;
    return this.parameter ? [...new Set(this.parameter.texts)] : this.runs.map(({ name }) => name);
  }

  /** The drawn lines. */
  get lines(): Line[] {
    const parameter = this.parameter;
    // An entry that follows from the abscissa, such as another component of the same vector, makes no lines of its own.
    const others = parameter ? this.parameters.filter((each) => !follows(each, parameter)) : [];
    const lines = new Map<string, Point[]>();
    this.runs.forEach((run, i) => {
      const x = !parameter ? i : parameter.numbers ? parameter.numbers[i] : this.categories!.indexOf(parameter.texts[i]);
      const name = others.map((other) => `${other.name} = ${other.texts[i]}`).join(", ");
      const points = lines.get(name) ?? [];
      lines.set(name, points);
      points.push({ run, x, y: this.quantity.value(run) });
    });
    for (const points of lines.values()) points.sort((a, b) => a.x - b.x);
    return [...lines].map(([name, points]) => ({ name, points }));
  }

  private get points(): Point[] {
    return this.lines.flatMap(({ points }) => points).filter(({ y }) => Number.isFinite(y));
  }

  rebuild(): void {
    this.plot?.destroy();
    this.plot = null;
    this.plotArea.replaceChildren();
    this.width = this.plotArea.clientWidth;
    if (this.width === 0) return;
    const { points, categories } = this;
    const without = this.runs.length - points.length;
    this.without.textContent = without > 0 ? `${without} of ${this.runs.length} runs do not have this result.` : "";
    const axis = axisStyle();
    const [low, high] = this.rangeOfY(points.map(({ y }) => y));
    const xs = points.map(({ x }) => x);
    const wide = !categories && Math.min(...xs) > 0 && Math.max(...xs) > 50 * Math.min(...xs);
    const xRange = categories ? [-0.6, categories.length - 0.4] : wide ? [Math.min(...xs) / 1.3, Math.max(...xs) * 1.3] : padded(xs);
    const decades: [number, number] = [low, high];
    // Only as many names as fit.
    const step = categories ? Math.ceil((categories.length * 90) / Math.max(this.width - 80, 90)) : 1;
    this.plot = new uPlot({
      width: this.width,
      height: this.width < 420 ? 210 : 260,
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: false, distr: wide ? 3 : 1, range: () => xRange as [number, number] },
        y: this.logarithmic ? { distr: 3, range: () => decades } : { range: () => [low, high] },
      },
      series: [{}, { show: true, stroke: "transparent", points: { show: false } }],
      axes: [
        { ...axis, space: 80, label: this.against, labelSize: 18, labelFont: "12px system-ui, sans-serif", size: 36, grid: { ...axis.grid, show: !categories },
          ...(categories ? { splits: () => categories.map((_, i) => i).filter((i) => i % step === 0), values: (_: uPlot, ticks: number[]) => ticks.map((i) => shortened(categories[i] ?? "")) } : { values: tickTexts }) },
        this.logarithmic ? { ...axis, size: axisWidth, values: tickTexts, splits: () => powersOfTen(decades), filter: (_, splits) => splits }
          : { ...axis, size: axisWidth, values: tickTexts },
      ],
      hooks: { draw: [(plot) => this.paint(plot)] },
    }, [xRange, [low, high]] as uPlot.AlignedData, this.plotArea);
  }

  private rangeOfY(values: number[]): [number, number] {
    if (this.logarithmic) return logarithmicRange([values]);
    // Bars begin at zero, and so do values close to it.
    const low = Math.min(...values);
    const high = Math.max(...values);
    if (this.categories || (low > 0 && low < 0.5 * high) || low * high <= 0) return padded([0, ...values]);
    return padded(values);
  }

  private paint(plot: uPlot): void {
    const { ctx } = plot;
    const scale = devicePixelRatio;
    const { left, top, width, height } = plot.bbox;
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    const at = ({ x, y }: Point): [number, number] => [plot.valToPos(x, "x", true), plot.valToPos(y, "y", true)];
    const lines = this.lines.map(({ name, points }) => ({ name, points: points.filter(({ y }) => Number.isFinite(y) && (!this.logarithmic || y > 0)) }));
    ctx.font = `${11 * scale}px system-ui, sans-serif`;
    // Names are written at the end where lines are farther apart.
    const spread = (end: number) => {
      const ends = lines.flatMap(({ points }) => points.slice(end).slice(0, 1)).map((point) => at(point)[1]);
      return Math.max(...ends) - Math.min(...ends);
    };
    const atStart = spread(0) > spread(-1);
    for (const { name, points } of lines) {
      if (this.categories || points.length < 2) continue;
      ctx.strokeStyle = ctx.fillStyle = themeColour("muted");
      ctx.lineWidth = 1.2 * scale;
      ctx.beginPath();
      points.forEach((point, i) => (i === 0 ? ctx.moveTo(...at(point)) : ctx.lineTo(...at(point))));
      ctx.stroke();
      if (lines.length < 2 || lines.length > 8) continue; // the tooltip has the names
      const [x, y] = at(points[atStart ? 0 : points.length - 1]);
      ctx.textAlign = atStart ? "left" : "right";
      const place = [x + (atStart ? 9 : -9) * scale, y < top + 22 * scale ? y + 15 * scale : y - 8 * scale] as const;
      ctx.strokeStyle = themeColour("panel"); // lines do not cross the letters
      ctx.lineWidth = 4 * scale;
      ctx.strokeText(name, ...place);
      ctx.fillText(name, ...place);
    }
    const bar = 0.62 * (plot.valToPos(1, "x", true) - plot.valToPos(0, "x", true));
    const foot = this.logarithmic ? top + height : plot.valToPos(0, "y", true);
    for (const point of lines.flatMap(({ points }) => points)) {
      const { run } = point;
      const [x, y] = at(point);
      ctx.globalAlpha = this.store.highlight === null || this.store.highlight === run.number ? 1 : 0.25;
      ctx.fillStyle = ctx.strokeStyle = runColour(run.number);
      ctx.lineWidth = 2 * scale;
      ctx.beginPath();
      if (this.against === byRun) ctx.rect(x - bar / 2, Math.min(y, foot), bar, Math.abs(foot - y));
      else ctx.arc(x, y, 5 * scale, 0, 2 * Math.PI);
      if (this.store.visible[run.number]) ctx.fill(); // hidden runs have only an outline
      ctx.stroke();
    }
    ctx.restore();
  }

  private nearest(event: MouseEvent): Point | null {
    const plot = this.plot;
    if (!plot) return null;
    const box = plot.over.getBoundingClientRect();
    const distance = ({ x, y }: Point) => {
      const across = plot.valToPos(x, "x") - (event.clientX - box.left);
      return this.against === byRun ? Math.abs(across) : Math.hypot(across, plot.valToPos(y, "y") - (event.clientY - box.top));
    };
    const best = this.points.reduce<Point | null>((near, point) => (near && distance(near) <= distance(point) ? near : point), null);
    return best && distance(best) < 40 ? best : null;
  }

  private pointed(event: PointerEvent): void {
    const near = this.nearest(event);
    this.tip.hidden = !near;
    this.store.setHighlight(near?.run.number ?? null);
    if (!near) return;
    const box = this.plotArea.getBoundingClientRect();
    const values = this.parameters.map(({ name, texts }) => `${name} = ${texts[this.runs.indexOf(near.run)]}`).slice(0, 4);
    this.tip.textContent = [`${near.run.name}: ${this.quantity.title} ${number(near.y, 5)}`, ...values].join(" · ");
    this.tip.style.left = `${Math.min(event.clientX - box.left + 12, box.width - 200)}px`;
    this.tip.style.top = `${event.clientY - box.top + 14}px`;
  }

  private savePicture(): void {
    const canvas = this.plot?.root.querySelector("canvas");
    if (!canvas) return;
    saveCanvas(withCaption(canvas, `${this.quantity.title} against ${this.against}`, [], themeColour("panel"), themeColour("text")),
      `${fileName(this.quantity.title)}.png`);
  }

  /** Saves a row for each run: its name, the entries that vary, the result. */
  private saveNumbers(): void {
    saveCsv(["run", ...this.parameters.map(({ name }) => name), this.quantity.title],
      [this.runs.map(({ name }) => name), ...this.parameters.map(({ numbers, texts }) => numbers ?? texts), this.runs.map((run) => this.quantity.value(run))],
      `${fileName(this.quantity.title)}.csv`);
  }
}

function padded(values: number[]): [number, number] {
  const low = Math.min(...values);
  const high = Math.max(...values);
  if (!(low < high)) return Number.isFinite(low) ? [low - (Math.abs(low) || 1) * 0.1, high + (Math.abs(high) || 1) * 0.1] : [0, 1];
  const margin = 0.07 * (high - low);
  return [low === 0 ? 0 : low - margin, high === 0 ? 0 : high + margin];
}

/** Whether equal values of `other` imply equal values of `each`. */
function follows(each: Parameter, other: Parameter): boolean {
  const seen = new Map<string, string>();
  return other.texts.every((text, i) => {
    if (!seen.has(text)) seen.set(text, each.texts[i]);
    return seen.get(text) === each.texts[i];
  });
}

const shortened = (text: string) => (text.length > 15 ? `…${text.slice(-14)}` : text);
