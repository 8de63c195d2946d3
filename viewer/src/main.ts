import { bodiesOf } from "./body/geometry";
import { cutOf } from "./body/section_view";
import { Stage, type View } from "./body/stage";
import { fieldNames } from "./body/fields";
import { TimeChart } from "./charts/chart";
import { chartDefinitions } from "./charts/definitions";
import { followSystem, runColour, toggleTheme } from "./colours";
import { readPage, type Run } from "./data/run";
import { details } from "./details";
import { el, select } from "./elements";
import { fieldName, namePairs, number } from "./format";
import { conclusion, findingsElement, methodWords } from "./glance";
import { connectKeys, helpDialog } from "./keys";
import { ContactMap } from "./maps/contact_map";
import { ProfileChart } from "./maps/profile";
import { Player } from "./player";
import type { ColourScale } from "./maps/colour_range";
import { outcomeElements } from "./results/outcomes";
import { ResultsChart } from "./results/results_chart";
import { runTable } from "./results/run_table";
import { Store, type Axis } from "./store";

/** Access of tests to the page. */
export interface Handle {
  store: Store;
  charts: TimeChart[];
  maps: ContactMap[];
  profile: ProfileChart;
  results: ResultsChart | null;
  stage: Stage | null;
  ready: boolean;
}

declare global {
  interface Window {
    ricochet?: Handle;
  }
}

/** Largest number of runs with a card each; more runs have a row each in a table. */
const mostCards = 6;

function title(runs: Run[]): string {
  const titles = [...new Set(runs.map((run) => run.summary.title || run.summary.case))];
  return titles.slice(0, 3).join(" · ") + (titles.length > 3 ? ` and ${titles.length - 3} more` : "");
}

/** The card of a run; a click on its name shows or hides the run in all plots. */
function card(store: Store, run: Run, stage: () => Stage | null): HTMLElement {
  const swatch = el("i");
  const button = el("button.toggle", { type: "button", title: `Show or hide ${run.name}${run.number < 9 ? ` (key ${run.number + 1})` : ""}. Shift-click shows this run alone.`, onclick: (event: MouseEvent) => (event.shiftKey ? store.only(run.number) : store.toggle(run.number)) }, swatch, run.name);
  const warnings = run.summary.warnings.length;
  const status = run.summary.status === "done" ? null : el("span.status", {}, run.summary.status);
  const findings = findingsElement(run);
  findings.append(...outcomeElements(run, { time: (time) => store.setTime(time), peak: () => stage()?.showPeak(run) }));
  const element = el("article.card", {}, el("h2", {}, button, status),
    el("p.muted", {}, methodWords(run.summary)), findings,
    warnings > 0 && el("a.warned", { href: "#messages" }, `${warnings} ${warnings === 1 ? "warning" : "warnings"}`));
  const show = () => {
    swatch.style.background = runColour(run.number);
    element.style.setProperty("--run", runColour(run.number));
    element.classList.toggle("off", !store.visible[run.number]);
    button.setAttribute("aria-pressed", String(store.visible[run.number]));
  };
  store.on("runs", show);
  store.on("theme", show);
  show();
  return element;
}

/** Panels of the visible runs side by side. */
function perRun(store: Store, runs: Run[], make: (run: Run) => HTMLElement, name: string): HTMLElement {
  const places = runs.map((run) => {
    const heading = el("h4", {}, run.name);
    return { run, heading, element: el("div.run-panel", {}, heading, make(run)) };
  });
  const element = el(`div.${name}`, {}, ...places.map((place) => place.element));
  element.classList.add("side-by-side");
  const show = () => {
    for (const place of places) {
      place.element.hidden = !store.visible[place.run.number];
      place.heading.style.color = runColour(place.run.number);
    }
    element.style.setProperty("--columns", String(Math.min(places.filter((p) => !p.element.hidden).length, 4) || 1));
  };
  store.on("runs", show);
  store.on("theme", show);
  show();
  return element;
}

function toggleButton(store: Store, key: "showMesh" | "showForces" | "sharedColours" | "whole", text: string, hint: string): HTMLElement {
  const button = el("button.small", { type: "button", title: hint, onclick: () => {
    store.set(key, !store[key], "body");
    if (key === "sharedColours") store.changed("contact");
  } }, text);
  const show = () => button.setAttribute("aria-pressed", String(store[key]));
  store.on("body", show);
  show();
  return button;
}

/** Choice of the plane that cuts solids. */
function cutTools(store: Store, stage: Stage, runs: Run[]): HTMLElement {
  const choice = select("cut", [["", "none"], ["x", "across x"], ["y", "across y"], ["z", "across z"]], store.cut, (value) => {
    store.set("cut", value as Axis | "", "body");
    if (value !== "") stage.look(value as Axis);
  });
  choice.control.id = "cut";
  const at = el("input", { type: "range", min: "0", max: "1", step: "0.005", value: String(store.cutAt), "aria-label": "Position of the cut" });
  at.addEventListener("input", () => store.set("cutAt", Number(at.value), "body"));
  const place = el("output");
  const other = el("button.small", { type: "button", title: "Show the removed side instead", onclick: () => store.set("cutFlipped", !store.cutFlipped, "body") }, "other side");
  const rest = el("span.control", {}, at, place, other);
  const show = () => {
    choice.control.value = store.cut;
    at.value = String(store.cutAt);
    rest.hidden = store.cut === "";
    const solid = stage.panels.find(({ view }) => view.section && store.visible[view.run.number])?.view;
    const cut = solid && cutOf(store, solid.start);
    place.textContent = cut ? `${store.cut} = ${number(cut.at, 3)}` : "";
    other.setAttribute("aria-pressed", String(store.cutFlipped));
  };
  store.on("body", show);
  store.on("runs", show);
  show();
  choice.element.title = `Section through the undeformed ${runs.length > 1 ? "solids" : "solid"}; it moves and deforms with ${runs.length > 1 ? "them" : "it"} (key x)`;
  return el("span.tools", {}, choice.element, rest);
}

function bodySection(store: Store, stage: Stage, runs: Run[]): HTMLElement {
  const names = fieldNames(runs);
  store.field = names.includes("von_mises") ? "von_mises" : (names[0] ?? "");
  const field = select("colour", [["", "none"], ...names.map((name): [string, string] => [name, fieldName(name)])], store.field,
    (value) => store.set("field", value, "body"));
  field.control.id = "field";
  store.on("body", () => (field.control.value = store.field));
  const scale = el("input", { type: "range", min: "0", max: "4", step: "0.01", value: "0", "aria-label": "Deformation scale" });
  const scaleText = el("output", {}, "1 ×");
  scale.addEventListener("input", () => store.set("deformation", Number((10 ** Number(scale.value)).toPrecision(2)), "body"));
  store.on("body", () => {
    scaleText.textContent = `${store.deformation} ×`;
    scale.value = String(Math.log10(store.deformation));
  });
  const space = runs.some((run) => run.summary.dimension === 3);
  store.showForces = !space; // in space, bars hide the pressures on the surface
  const view = (name: View, text: string = name, title = "") =>
    el("button.small", { type: "button", title, onclick: () => stage.look(name) }, text);
  const contact = runs.some((run) => run.contact !== null);
  const colours = select("scale", [["automatic", "automatic"], ["most", "fit most"], ["all", "fit all"], ["logarithmic", "logarithmic"]], store.scale,
    (value) => store.set("scale", value as ColourScale, "body"));
  colours.control.id = "scale";
  store.on("body", () => (colours.control.value = store.scale));
  const several = runs.some((run) => run.body !== null && bodiesOf(run.body) !== null);
  return el("section.panel", { id: "bodies" },
    el("header", {}, el("h3", {}, several ? "Bodies" : "Body"),
      el("div.tools", {}, field.element, colours.element,
        el("label.control", { title: "Scale of the deformation relative to the mean displacement, which is never scaled" }, el("span", {}, "deformation"), scale, scaleText),
        toggleButton(store, "showForces", "pressures", "Show contact pressures as bars (key p)"),
        toggleButton(store, "showMesh", "mesh", "Show the edges of the cells (key m)"),
        runs.some((run) => run.isAxisymmetric) && toggleButton(store, "whole", "whole", "Show axisymmetric bodies with the mirror image of their section (key w)"),
        runs.length > 1 && toggleButton(store, "sharedColours", "same colours", "Use one range of colours for all runs, in bodies and maps (key c)"))),
    el("div.tools", {},
      ...(space ? (["front", "side", "top", "below"] as const).map((name) => view(name)) : [view("front", "fit")]),
      contact && view("contact", "contact zone", `Show the contact zone${space ? ", seen from behind the obstacle" : ""} (key k)`),
      contact && space && view("contact-side", "contact, from the side", "Show the contact zone, seen along the obstacle"),
      runs.some((run) => run.body!.volume !== null) && cutTools(store, stage, runs)),
    perRun(store, runs, (run) => stage.add(run).element, "bodies"));
}

function contactSection(store: Store, runs: Run[], maps: ContactMap[]): HTMLElement {
  const names = [...new Set(runs.flatMap((run) => run.contact!.quantities.map(({ name }) => name)))];
  const quantity = select("quantity", names.map((name): [string, string] => [name, fieldName(name)]), store.quantity,
    (value) => store.set("quantity", value, "contact"));
  quantity.control.id = "quantity";
  store.on("contact", () => (quantity.control.value = store.quantity));
  return el("section.panel", { id: "maps" },
    el("header", {}, el("h3", {}, "Contact boundary over time"), el("div.tools", {}, quantity.element)),
    perRun(store, runs, (run) => {
      const map = new ContactMap(store, run);
      maps.push(map);
      return map.element;
    }, "maps"));
}

/** Time at which the page opens: that of the largest contact force of all runs. */
function interestingTime(runs: Run[]): number {
  const most = (run: Run) => run.data.judgement.force_largest;
  const judged = runs.filter((run) => run.data.judgement.force_broken_at === null && most(run) > 0);
  return judged.length === 0 ? 0 : judged.reduce((best, run) => (most(run) > most(best) ? run : best)).largestForceTime;
}

async function start(): Promise<void> {
  const page = document.getElementById("page")!;
  const runs = readPage();
  namePairs(runs.map((run) => run.summary.contacts));
  await Promise.all(runs.map((run) => run.loadHistory()));
  const store = new Store(runs);
  store.time = Math.min(Math.max(interestingTime(runs), store.start), store.end);
  document.title = `${title(runs)} – Ricochet report`;
  followSystem(() => store.changed("theme"));
  const switchTheme = () => {
    toggleTheme();
    store.changed("theme");
  };

  const charts = chartDefinitions(runs).map((definition) => new TimeChart(store, definition));
  const chart = (id: string) => charts.find((each) => each.id === id)?.element ?? "";
  const frames = [...new Set(runs.flatMap((run) => run.data.body?.times ?? run.data.contact?.times ?? []))].sort((a, b) => a - b);
  const player = new Player(store, frames.length > 0 ? frames : Array.from(runs[0].column("time")));
  const help = helpDialog();
  const sentence = conclusion(runs);
  const moving = el("div", { id: "moving" }, el("p.note", {}, "Unpacking the frames…"));
  const rest = charts.filter((each) => !["energy", "force"].includes(each.id)).map((each) => each.element);
  const profile = new ProfileChart(store);
  const results = runs.length > 1 ? new ResultsChart(store, runs) : null;
  page.replaceChildren(
    el("header.top", {},
      el("div", {}, el("h1", {}, title(runs)), sentence !== "" && el("p.conclusion", {}, sentence)),
      el("div.tools", {},
        runs.length > 2 && el("button.small", { type: "button", onclick: () => store.all() }, "all runs"),
        el("button.small", { type: "button", title: "List of the keys (key ?)", onclick: () => help.showModal() }, "keys"),
        el("button.small", { type: "button", title: "Switch between the dark and the light theme (key t)", onclick: switchTheme }, "dark / light"))),
    runs.length > mostCards ? runTable(store, runs) : el("div.cards", {}, ...runs.map((run) => card(store, run, () => window.ricochet?.stage ?? null))),
    results?.isTrend ? el("div.results-first", {}, results.element) : "",
    el("div.charts", {}, chart("force"), chart("energy")),
    moving,
    el("div.charts", {}, profile.element, ...(results && !results.isTrend ? [results.element] : []), ...rest),
    details(store),
    el("footer.made", {}, `Written by Ricochet ${runs[0].summary.ricochet_version}. Runs: ${runs.map((run) => run.data.directory).join(", ")}`),
    player.element,
    help,
  );
  for (const each of charts) each.rebuild();
  results?.rebuild();
  const handle: Handle = { store, charts, maps: [], profile, results, stage: null, ready: false };
  window.ricochet = handle;
  connectKeys(store, player, help, () => handle.stage, switchTheme);

  await Promise.all(runs.map((run) => run.loadContact()));
  await Promise.all(runs.map((run) => run.loadBody()));
  moving.replaceChildren();
  const touching = runs.filter((run) => run.contact !== null && run.contact.quantities.length > 0);
  const plane = touching.filter((run) => run.contact!.position.length > 0);
  if (plane.length > 0 && !plane.some((run) => run.contact!.quantities.some(({ name }) => name === store.quantity)))
    store.quantity = plane[0].contact!.quantities[0].name;
  const bodies = runs.filter((run) => run.body !== null && run.body.times.length > 0);
  if (bodies.length > 0) {
    handle.stage = new Stage(store);
    moving.append(bodySection(store, handle.stage, bodies));
  } else {
    moving.append(el("p.note", {}, "The runs wrote no fields, so there is nothing to animate."));
  }
  if (plane.length > 0) moving.append(contactSection(store, plane, handle.maps));
  profile.rebuild();
  store.changed("contact");
  store.changed("body");
  store.changed("time");
  handle.ready = true;
}

start().catch((problem: unknown) => {
  document.getElementById("page")!.replaceChildren(
    el("p.warning", {}, `This report cannot be shown: ${problem instanceof Error ? problem.message : String(problem)}`));
  throw problem;
});
