import type { Stage } from "./body/stage";
import { el } from "./elements";
import type { Player } from "./player";
import type { Store } from "./store";

const keys: [string, string][] = [
  ["space", "play or pause"],
  ["← →", "previous, next frame (with shift: ten frames)"],
  ["home, end", "start, end of the run"],
  ["1 … 9", "show or hide a run (shift-click on its name: show it alone)"],
  ["a", "show all runs"],
  ["f", "next field"],
  ["+ −", "increase, decrease the scale of deformation"],
  ["p", "contact pressures as bars"],
  ["m", "edges of the cells"],
  ["w", "whole axisymmetric bodies, or their sections"],
  ["c", "one range of colours for all runs"],
  ["r", "whole body, from the front"],
  ["k", "contact zone"],
  ["x", "cut solids across x, y, z, or not at all"],
  ["z", "whole time (or double-click on a plot)"],
  ["t", "dark or light theme"],
  ["?", "this list"],
];

export function helpDialog(): HTMLDialogElement {
  const dialog = el("dialog.help", {},
    el("h2", {}, "Keys"),
    el("dl", {}, ...keys.flatMap(([key, what]) => [el("dt", {}, el("kbd", {}, key)), el("dd", {}, what)])),
    el("p.note", {}, "Move over a plot or a map to show that time everywhere. Drag over a plot to zoom into an interval of time. Click on a body to zoom with the wheel; drag to rotate or move it."),
    el("button.small", { type: "button", onclick: () => dialog.close() }, "close"));
  return dialog;
}

export function connectKeys(store: Store, player: Player, help: HTMLDialogElement, stage: () => Stage | null, toggleTheme: () => void): void {
  const nextField = () => {
    const control = document.querySelector<HTMLSelectElement>("#field");
    if (!control) return;
    control.selectedIndex = (control.selectedIndex + 1) % control.options.length;
    store.set("field", control.value, "body");
  };
  const deform = (by: number) => {
    const steps = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000];
    const at = steps.findIndex((step) => step >= store.deformation);
    store.set("deformation", steps[Math.min(Math.max(at + by, 0), steps.length - 1)], "body");
  };
  const actions: Record<string, (event: KeyboardEvent) => void> = {
    " ": () => player.toggle(),
    ArrowLeft: (event) => player.step(event.shiftKey ? -10 : -1),
    ArrowRight: (event) => player.step(event.shiftKey ? 10 : 1),
    Home: () => store.setTime(store.start),
    End: () => store.setTime(store.end),
    f: nextField,
    "+": () => deform(1),
    "=": () => deform(1),
    "-": () => deform(-1),
    p: () => store.set("showForces", !store.showForces, "body"),
    m: () => store.set("showMesh", !store.showMesh, "body"),
    w: () => store.set("whole", !store.whole, "body"),
    c: () => {
      store.set("sharedColours", !store.sharedColours, "body");
      store.changed("contact");
    },
    r: () => stage()?.look("front"),
    k: () => stage()?.look("contact"),
    x: () => {
      const axes = ["", "x", "y", "z"] as const;
      const solids = store.runs.some((run) => run.body?.volume);
      if (solids) store.set("cut", axes[(axes.indexOf(store.cut) + 1) % 4], "body");
    },
    a: () => store.all(),
    z: () => store.setZoom(null),
    t: toggleTheme,
    "?": () => help.showModal(),
  };
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || help.open) return;
    if (target instanceof HTMLSelectElement) return;
    // The space bar presses a button that has the focus; arrows move a slider.
    if (event.key === " " && (target instanceof HTMLButtonElement || target.tagName === "SUMMARY")) return;
    if (target instanceof HTMLInputElement && /^(Arrow|Home|End)/.test(event.key)) return;
    const digit = Number(event.key);
    if (digit >= 1 && digit <= store.runs.length) store.toggle(digit - 1);
    else if (actions[event.key]) actions[event.key](event);
    else return;
    event.preventDefault();
  });
}
