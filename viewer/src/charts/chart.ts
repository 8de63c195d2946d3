import uPlot from "uplot";
import { runColour, themeColour } from "../colours";
import type { Run } from "../data/run";
import { el, select } from "../elements";
import { columnName, number } from "../format";
import { fileName, saveCanvas, saveCsv, withCaption } from "../save";
import type { Store } from "../store";
import type { ChartDefinition } from "./definitions";
import { axisStyle, axisWidth, tickTexts } from "./axes";
import { chooseRange, extentOf, logarithmicRange, powersOfTen, type ScaleMode } from "./scale";
import { joined, type Curve } from "./table";

interface Series extends Curve {
  run: Run;
  column: string;
  label: string;
  colour: string;
  dash: number[];
}

const dashes = [[], [7, 4], [2, 3], [10, 3, 2, 3], [14, 5], [4, 2, 1, 2]];

/** Curves of the history over time, of all visible runs in one plot. */
export class TimeChart {
  readonly element: HTMLElement;
  private readonly plotArea = el("div.plot");
  private readonly legend = el("div.legend");
  private readonly outside = el("p.outside");
  private readonly choices = el("div.choices", { role: "group", "aria-label": "Curves" });
  private plot: uPlot | null = null;
  private series: Series[] = [];
  private shown: Set<string>;
  private mode: ScaleMode = "most";
  private relative = false;
  private ownCursor = false;
  private width = 0;

  constructor(
    private readonly store: Store,
    private readonly definition: ChartDefinition,
  ) {
    this.shown = new Set(definition.shown);
    const scale = select(
      "scale",
      [["most", "fit most"], ["all", "fit all"], ["logarithmic", "logarithmic"]],
      this.mode,
      (value) => {
        this.mode = value as ScaleMode;
        this.rebuild();
      },
    );
    scale.control.dataset.chart = definition.id;
    const relative = el("button.small", {
      type: "button",
      "aria-pressed": "false",
      title: "Show the change since the start, relative to the initial value",
      onclick: () => {
        this.relative = !this.relative;
        relative.setAttribute("aria-pressed", String(this.relative));
        this.rebuild();
      },
    }, "change, %");
    this.element = el("section.chart.panel", { id: `chart-${definition.id}` },
      el("header", {},
        el("h3", {}, definition.title),
        el("div.tools", {},
          definition.relative === true && relative,
          scale.element,
          el("button.small", { type: "button", title: "Save the picture as PNG", onclick: () => this.savePicture() }, "PNG"),
          el("button.small", { type: "button", title: "Save the numbers as CSV", onclick: () => this.saveNumbers() }, "CSV"),
        ),
      ),
      definition.note !== "" && el("p.note", {}, definition.note),
      this.choices,
      this.outside,
      this.plotArea,
      this.legend,
    );
    this.fillChoices();
    store.on("runs", () => this.rebuild());
    store.on("theme", () => this.rebuild());
    store.on("time", () => this.showTime());
    store.on("zoom", () => this.showZoom());
    store.on("highlight", () => this.showHighlight());
    this.legend.addEventListener("pointerover", (event) => {
      const run = (event.target as HTMLElement).closest<HTMLElement>("[data-run]")?.dataset.run;
      if (store.runs.length > 1) store.setHighlight(run === undefined ? null : Number(run));
    });
    this.legend.addEventListener("pointerleave", () => store.setHighlight(null));
    new ResizeObserver(() => this.resize()).observe(this.plotArea);
  }

  /** The drawn curves, for tests. */
  get curves(): { run: string; column: string; times: Float64Array; values: Float64Array }[] {
    return this.series.map(({ run, column, times, values }) => ({ run: run.name, column, times, values }));
  }
  get id(): string {
    return this.definition.id;
  }
  get range(): { low: number; high: number } {
    return { low: this.plot?.scales.y.min ?? NaN, high: this.plot?.scales.y.max ?? NaN };
  }

  private fillChoices(): void {
    const { columns } = this.definition;
    if (columns.length < 2) return;
    if (columns.length > 8) {
      const chooser = select("curve", columns.map((name) => [name, columnName(name)]), this.definition.shown[0],
        (value) => {
          this.shown = new Set([value]);
          this.rebuild();
        });
      chooser.control.dataset.curves = this.definition.id;
      this.choices.append(chooser.element);
      return;
    }
    for (const column of columns) {
      const button = el("button.choice", {
        type: "button",
        "aria-pressed": String(this.shown.has(column)),
        onclick: () => {
          if (this.shown.has(column) && this.shown.size > 1) this.shown.delete(column);
          else this.shown.add(column);
          button.setAttribute("aria-pressed", String(this.shown.has(column)));
          this.rebuild();
        },
      }, columnName(column));
      this.choices.append(button);
    }
  }

  private collect(): void {
    // Smooth curves are drawn above rattling ones.
    const runs = [...this.store.visibleRuns].sort((a, b) => b.data.judgement.roughness - a.data.judgement.roughness);
    const columns = this.definition.columns.filter((column) => this.shown.has(column));
    this.series = [];
    for (const run of runs) {
      for (const column of columns) {
        if (!run.has(column)) continue;
        let values = run.column(column);
        if (this.relative) {
          const first = values[0];
          values = values.map((value) => (100 * (value - first)) / Math.abs(first));
        }
        const several = columns.length > 1;
        const byColumn = this.store.runs.length === 1;
        this.series.push({
          run,
          column,
          times: run.timesOf(column),
          values,
          label: byColumn ? columnName(column) : several ? `${run.name}: ${columnName(column)}` : run.name,
          colour: byColumn ? runColour(columns.indexOf(column)) : runColour(run.number),
          dash: byColumn ? [] : dashes[columns.indexOf(column) % dashes.length],
        });
      }
    }
  }

  rebuild(): void {
    this.collect();
    const { times, columns } = joined(this.series);
    const logarithmic = this.mode === "logarithmic";
    const data = columns.map((column) =>
      logarithmic ? Array.from(column, (value) => (typeof value === "number" && value > 0 ? value : value === undefined ? undefined : null)) : column,
    );
    const range = chooseRange(
      this.store.visibleRuns.map((run) => {
        const own = this.series.filter((series) => series.run === run).map((s) => extentOf(run.name, s.values));
        return { name: run.name, low: Math.min(...own.map((e) => e.low)), high: Math.max(...own.map((e) => e.high)) };
      }),
      this.mode,
      this.relative ? 0.01 : 0,
    );
    if (this.definition.fromZero && !this.relative && !logarithmic && this.store.runs.length > 1) {
      range.low = Math.min(range.low, 0);
      range.high = Math.max(range.high, 0);
    }
    const decades = logarithmicRange(this.series.map((series) => series.values));
    this.outside.replaceChildren(
      ...range.outside.map((e) => {
        const far = Math.abs(e.high) >= Math.abs(e.low) ? e.high : e.low;
        const text = `${e.name} exceeds this scale and reaches ${number(far)}${this.relative ? " %" : ""} — `;
        return el("span", {}, text, el("button.link", { type: "button", onclick: () => this.setMode("all") }, "fit all"));
      }),
    );
    this.outside.hidden = range.outside.length === 0;
    this.plot?.destroy();
    this.plot = null;
    this.width = this.plotArea.clientWidth;
    if (this.width === 0) return;
    const axis = axisStyle();
    const options: uPlot.Options = {
      width: this.width,
      height: this.height,
      legend: { show: false },
      scales: {
        x: { time: false, range: (_, low, high) => this.store.zoom ?? [Math.min(low, this.store.start), Math.max(high, this.store.end)] },
        y: logarithmic ? { distr: 3, range: () => decades } : { range: () => [range.low, range.high] },
      },
      series: [
        {},
        ...this.series.map((series, i) => ({
          // Values at times of other curves are undefined and no gap; values that a logarithm excludes are null and a gap.
          label: series.label, stroke: series.colour, dash: series.dash, spanGaps: false, width: this.widthOf(i),
          points: { show: series.times.length < 60 },
        })),
      ],
      axes: [
        { ...axis, label: "time", labelSize: 18, labelFont: "12px system-ui, sans-serif", size: 34, space: 80, values: tickTexts },
        // uPlot's own ticks do not terminate for very small numbers.
        logarithmic ? { ...axis, size: axisWidth, values: tickTexts, splits: () => powersOfTen(decades), filter: (_, splits) => splits }
          : { ...axis, size: axisWidth, values: tickTexts },
      ],
      cursor: { y: false, drag: { x: true, y: false, setScale: false }, points: { size: 7 } },
      hooks: {
        ready: [() => this.placeCursor()],
        setCursor: [(plot) => this.cursorMoved(plot)],
        setSelect: [(plot) => this.selected(plot)],
      },
    };
    this.plotArea.replaceChildren();
    this.plot = new uPlot(options, [times, ...data] as uPlot.AlignedData, this.plotArea);
    this.listen(this.plot);
    this.placeCursor();
    this.showValues();
  }

  /** Width of a curve: of smooth curves that may coincide the lower ones are wider; rattling curves are thin. */
  private widthOf(i: number): number {
    if (this.store.runs.length === 1 || this.series.length > 4) return 1.6;
    const rattles = (series: Series) => !this.definition.nested && series.run.data.judgement.roughness > 2;
    if (rattles(this.series[i])) return 1.2;
    const above = this.series.slice(i + 1).filter((series) => !rattles(series)).length;
    return (this.definition.nested ? 2 : 1.8) + (this.definition.nested ? 2.4 : 1.8) * Math.min(above, 2);
  }

  private listen(plot: uPlot): void {
    const over = plot.over;
    over.addEventListener("dblclick", () => this.store.setZoom(null));
    // Fingers do not hover.
    over.addEventListener("pointermove", (event) => {
      if (event.pointerType === "mouse") return;
      this.store.setTime(plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x"));
    });
    over.addEventListener("pointerdown", (event) => {
      if (event.pointerType === "mouse") return;
      this.store.setTime(plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x"));
    });
  }

  private setMode(mode: ScaleMode): void {
    this.mode = mode;
    const control = this.element.querySelector<HTMLSelectElement>("select[data-chart]");
    if (control) control.value = mode;
    this.rebuild();
  }

  private get height(): number {
    return this.width < 420 ? 190 : 230;
  }

  private resize(): void {
    if (this.plotArea.clientWidth === this.width) return;
    if (!this.plot) return this.rebuild();
    this.width = this.plotArea.clientWidth;
    if (this.width > 0) this.plot.setSize({ width: this.width, height: this.height });
  }

  private cursorMoved(plot: uPlot): void {
    const { left, event } = plot.cursor;
    if (this.ownCursor || !event || left === undefined || left < 0 || this.store.playing) return;
    this.store.setTime(plot.posToVal(left, "x"), this);
  }

  private selected(plot: uPlot): void {
    const { left, width } = plot.select;
    if (width < 4) return;
    this.store.setZoom([plot.posToVal(left, "x"), plot.posToVal(left + width, "x")]);
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  }

  private showZoom(): void {
    const plot = this.plot;
    if (!plot) return;
    const [min, max] = this.store.zoom ?? [this.store.start, this.store.end];
    plot.setScale("x", { min, max });
  }

  private showHighlight(): void {
    const { highlight } = this.store;
    this.series.forEach(({ run }, i) => {
      if (this.plot) this.plot.series[i + 1].alpha = highlight === null || highlight === run.number ? 1 : 0.15;
    });
    this.plot?.redraw(false);
  }

  private showTime(): void {
    const plot = this.plot;
    if (!plot) return;
    if (this.store.timeSource !== this) this.placeCursor();
    this.showValues();
  }

  private placeCursor(): void {
    const plot = this.plot;
    if (!plot) return;
    this.ownCursor = true;
    plot.setCursor({ left: plot.valToPos(this.store.time, "x"), top: 0 });
    this.ownCursor = false;
  }

  private showValues(): void {
    const unit = this.relative ? " %" : "";
    const inOrder = [...this.series].sort((a, b) => a.run.number - b.run.number);
    const items = inOrder.map((series) => {
      const value = valueNear(series, this.store.time);
      return el("span.item", { "data-run": String(series.run.number) },
        series.dash.length > 0 ? el("i.dashed", { style: `border-color:${series.colour}` }) : el("i", { style: `background:${series.colour}` }),
        `${series.label} `,
        el("b", {}, number(value, 6) + unit));
    });
    this.legend.replaceChildren(...items);
  }

  private savePicture(): void {
    const canvas = this.plot?.root.querySelector("canvas");
    if (!canvas) return;
    const names = this.series.map(({ label, colour }) => ({ text: label, colour }));
    const title = this.series.length > 0 && this.shown.size === 1 ? `${this.definition.title}: ${columnName([...this.shown][0])}` : this.definition.title;
    saveCanvas(withCaption(canvas, title, names, themeColour("panel"), themeColour("text")),
      `${fileName(this.definition.title)}.png`);
  }

  /** Saves each curve with its own times, as energies and forces of a scheme may hold at different instants. */
  private saveNumbers(): void {
    const names = this.series.flatMap(({ run, column }) => [`${run.name}: time of ${column}`, `${run.name}: ${column}`]);
    const columns = this.series.flatMap(({ times, values }) => [times, values]);
    saveCsv(names, columns, `${fileName(this.definition.title)}.csv`);
  }
}

/** The value of the row nearest in time; NaN after the end of the run. */
function valueNear({ times, values }: Curve, time: number): number {
  const last = times.length - 1;
  if (time > times[last] + 1.5 * (times[last] - times[Math.max(last - 2, 0)])) return NaN;
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1;
    else high = middle;
  }
  if (low > 0 && time - times[low - 1] <= times[low] - time) --low;
  return values[low];
}
