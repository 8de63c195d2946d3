import { runColour } from "./colours";
import { el, select } from "./elements";
import { number } from "./format";
import type { Store } from "./store";

/** The bar at the foot of the page: play, pause and scrub. */
export class Player {
  readonly element: HTMLElement;
  private readonly button = el("button.play", { type: "button", onclick: () => this.toggle() });
  private readonly slider = el("input", { type: "range", min: "0", max: "10000", step: "1", "aria-label": "Time" });
  private readonly label = el("output");
  private last = 0;

  constructor(private readonly store: Store, private readonly frames: number[]) {
    this.slider.addEventListener("input", () => {
      this.pause();
      store.setTime(store.start + (Number(this.slider.value) / 10000) * (store.end - store.start), this);
    });
    const speed = select("playing time", [["4", "4 s"], ["10", "10 s"], ["20", "20 s"], ["60", "1 min"]], String(store.duration),
      (value) => store.set("duration", Number(value), "player"));
    speed.control.title = "Time in which the whole run is played";
    this.element = el("footer.player", {}, this.button, this.slider, this.label, this.chips(), speed.element);
    store.on("time", () => this.show());
    store.on("player", () => this.show());
    this.show();
  }

  /** Buttons that show and hide runs, visible at every scroll position. */
  private chips(): HTMLElement {
    const { store } = this;
    const place = el("div.chips", { role: "group", "aria-label": "Runs" });
    if (store.runs.length < 2) return place;
    const all = store.runs.map((run) => {
      const swatch = el("i");
      const chip = el("button.chip", { type: "button", title: `Show or hide ${run.name}. Shift-click shows this run alone.`, onclick: (event: MouseEvent) => (event.shiftKey ? store.only(run.number) : store.toggle(run.number)) },
        swatch, el("span", {}, run.name));
      place.append(chip);
      return { run, swatch, chip };
    });
    const show = () => {
      for (const { run, swatch, chip } of all) {
        swatch.style.background = runColour(run.number);
        chip.setAttribute("aria-pressed", String(store.visible[run.number]));
      }
    };
    store.on("runs", show);
    store.on("theme", show);
    show();
    return place;
  }

  toggle(): void {
    if (this.store.playing) this.pause();
    else this.play();
  }

  play(): void {
    const { store } = this;
    if (store.time >= store.end) store.setTime(store.start);
    store.set("playing", true, "player");
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  pause(): void {
    this.store.set("playing", false, "player");
  }

  /** Moves by this number of frames. */
  step(by: number): void {
    this.pause();
    const { store, frames } = this;
    let at = frames.findIndex((time) => time >= store.time - 1e-12 * (store.end - store.start));
    if (at < 0) at = frames.length - 1;
    if (by < 0 || frames[at] <= store.time + 1e-12 * (store.end - store.start)) at += by;
    store.setTime(frames[Math.min(Math.max(at, 0), frames.length - 1)] ?? store.time);
  }

  private tick(now: number): void {
    const { store } = this;
    if (!store.playing) return;
    const time = store.time + ((now - this.last) / 1000 / store.duration) * (store.end - store.start);
    this.last = now;
    if (time >= store.end) {
      store.setTime(store.end);
      this.pause();
      return;
    }
    store.setTime(time);
    requestAnimationFrame((next) => this.tick(next));
  }

  private show(): void {
    const { store } = this;
    const playing = store.playing;
    this.button.textContent = playing ? "❚❚" : "▶";
    this.button.setAttribute("aria-label", playing ? "Pause" : "Play");
    this.button.title = `${playing ? "Pause" : "Play"} (space)`;
    if (document.activeElement !== this.slider || playing)
      this.slider.value = String(Math.round((10000 * (store.time - store.start)) / (store.end - store.start || 1)));
    this.label.textContent = `t = ${number(store.time, 5)}`;
  }
}
