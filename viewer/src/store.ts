import type { Run } from "./data/run";
import type { ColourScale } from "./maps/colour_range";

/** Parts of the state that all sections of the page share; listeners are notified of changes by topic. */
export type Topic = "highlight" | "time" | "runs" | "zoom" | "body" | "contact" | "theme" | "player";

export type Axis = "x" | "y" | "z";

export class Store {
  time = 0;
  /** Sender of the last change of time; its own cursor need not follow. */
  timeSource: unknown = null;
  playing = false;
  /** Seconds in which the whole run is played. */
  duration = 10;
  visible: boolean[];
  /** The run under the pointer; the others are drawn faintly. */
  highlight: number | null = null;
  zoom: [number, number] | null = null;
  deformation = 1;
  field = "";
  showMesh = false;
  showForces = true;
  sharedColours = false;
  /** Axisymmetric bodies are shown with the mirror image of their section. */
  whole = true;
  scale: ColourScale = "automatic";
  /** Solids are cut across this axis; the part beyond the fraction `cutAt` of their initial extent is removed. */
  cut: Axis | "" = "";
  cutAt = 0.5;
  /** The other side is removed. */
  cutFlipped = false;
  quantity = "contact_pressure";
  readonly start: number;
  readonly end: number;
  private readonly listeners = new Map<Topic, Set<() => void>>();
  private readonly waiting = new Set<Topic>();

  constructor(readonly runs: Run[]) {
    // At most as many as the page can draw bodies.
    this.visible = runs.map((_, i) => i < 12);
    let start = Infinity;
    let end = -Infinity;
    for (const run of runs) {
      const times = run.column("time");
      start = Math.min(start, times[0] ?? 0);
      end = Math.max(end, times[times.length - 1] ?? 0);
    }
    this.start = start;
    this.end = end;
    this.time = start;
  }

  get visibleRuns(): Run[] {
    return this.runs.filter((_, i) => this.visible[i]);
  }

  on(topic: Topic, listener: () => void): void {
    let set = this.listeners.get(topic);
    if (!set) this.listeners.set(topic, (set = new Set()));
    set.add(listener);
  }

  /** Notifies the listeners once before the next picture is drawn, however many changes there are. */
  changed(topic: Topic): void {
    if (this.waiting.size === 0) requestAnimationFrame(() => this.tell());
    this.waiting.add(topic);
  }

  private tell(): void {
    const topics = [...this.waiting];
    this.waiting.clear();
    for (const topic of topics) for (const listener of this.listeners.get(topic) ?? []) listener();
  }

  setTime(time: number, source: unknown = null): void {
    const bounded = Math.min(Math.max(time, this.start), this.end);
    if (!(bounded === bounded) || bounded === this.time) return;
    this.time = bounded;
    this.timeSource = source;
    this.changed("time");
  }

  toggle(run: number): void {
    this.visible[run] = !this.visible[run];
    if (!this.visible.includes(true)) this.visible[run] = true; // one run stays visible
    this.changed("runs");
  }

  /** Shows this run alone. */
  only(run: number): void {
    this.visible = this.runs.map((_, i) => i === run);
    this.changed("runs");
  }

  all(): void {
    this.visible = this.runs.map(() => true);
    this.changed("runs");
  }

  setHighlight(run: number | null): void {
    if (this.highlight === run) return;
    this.highlight = run;
    this.changed("highlight");
  }

  setZoom(zoom: [number, number] | null): void {
    this.zoom = zoom;
    this.changed("zoom");
  }

  set<Key extends "deformation" | "field" | "showMesh" | "showForces" | "duration" | "playing" | "quantity" | "sharedColours" | "whole" | "scale" | "cut" | "cutAt" | "cutFlipped">(
    key: Key,
    value: this[Key],
    topic: Topic,
  ): void {
    if (this[key] === value) return;
    this[key] = value;
    this.changed(topic);
  }
}
