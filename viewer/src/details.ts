import { runColour } from "./colours";
import type { Run } from "./data/run";
import { el } from "./elements";
import { count, number, seconds, toNumber } from "./format";
import { reactionsWords } from "./glance";
import { impactTable } from "./results/outcomes";
import type { Store } from "./store";

/** Inputs, sizes, timings and warnings, in tables with a column for each run. */

type Row = [name: string, ...values: (string | HTMLElement)[]];

function table(runs: Run[], rows: Row[]): HTMLElement {
  const head = el("tr", {}, el("th"), ...runs.map((run) => el("th", { style: `color:${runColour(run.number)}` }, run.name)));
  return el("div.table", {}, el("table", {}, el("thead", {}, head), el("tbody", {}, ...rows.map(([name, ...values]) => {
    const differs = new Set(values.map((value) => (typeof value === "string" ? value : value.textContent))).size > 1;
    return el("tr", { className: differs ? "differs" : "" }, el("th", { scope: "row" }, name), ...values.map((value) => el("td", {}, value)));
  }))));
}

function section(title: string, open: boolean, ...content: (Node | string)[]): HTMLElement {
  return el("details.panel", { open }, el("summary", {}, title), ...content);
}

const rowsOf = (runs: Run[], entries: [string, (run: Run) => string][]): Row[] =>
  entries.map(([name, value]) => [name, ...runs.map(value)]);

function sizes(runs: Run[]): HTMLElement {
  return table(runs, rowsOf(runs, [
    ["scheme", ({ summary }) => summary.scheme],
    ["mass", ({ summary }) => summary.mass],
    ["acting reactions", ({ summary }) => reactionsWords(summary) || "–"],
    ["time step", ({ summary }) => summary.adaptive_steps ? `${number(summary.adaptive_steps.shortest, 4)} to ${number(summary.adaptive_steps.longest, 4)}, ${count(summary.adaptive_steps.refused)} refused` : number(summary.time_step, 6)],
    ["steps", ({ summary }) => count(summary.steps) + (summary.steps < summary.steps_asked_for ? ` of ${count(summary.steps_asked_for)}` : "")],
    ["dimension, degree", ({ summary }) => `${summary.dimension}, ${summary.degree}`],
    ["nodes", ({ summary }) => count(summary.nodes)],
    ["cells", ({ summary }) => count(summary.cells)],
    ["degrees of freedom", ({ summary }) => count(summary.dofs)],
    ["contact points", ({ summary }) => count(summary.contact_points)],
    ["solver", ({ summary }) => summary.solver],
    ["entries of the factor", ({ summary }) => count(summary.factor_entries)],
    ["frames", ({ summary }) => count(summary.frames)],
    ["instant of the energies", ({ summary }) => summary.instants.energy.replace("+0 time_step", "").replace("time_step", "time steps")],
    ["instant of the forces", ({ summary }) => summary.instants.force.replace("+0 time_step", "").replace("time_step", "time steps")],
    ["Ricochet", ({ summary }) => summary.ricochet_version],
    ["libraries", ({ summary }) => summary.libraries],
  ]));
}

function inputs(runs: Run[]): HTMLElement {
  const keys = [...new Set(runs.flatMap((run) => Object.keys(run.summary.parameters)))].filter((key) => !key.startsWith("expect."));
  const place = el("div");
  const differing = keys.filter((key) => new Set(runs.map((run) => run.summary.parameters[key])).size > 1);
  const fill = (all: boolean) => {
    const shown = all ? keys : differing;
    place.replaceChildren(table(runs, shown.map((key) => [key, ...runs.map((run) => run.summary.parameters[key] ?? "–")])));
  };
  if (runs.length < 2) {
    fill(true);
    return place;
  }
  const button = el("button.small", { type: "button", "aria-pressed": "false", onclick: () => {
    const all = button.getAttribute("aria-pressed") === "false";
    button.setAttribute("aria-pressed", String(all));
    fill(all);
  } }, `show all ${keys.length} entries`);
  fill(false);
  return el("div", {}, el("p.note", {}, `${differing.length} entries differ between the runs. `, button), place);
}

function timings(runs: Run[]): HTMLElement {
  const phases = [...new Set(runs.flatMap((run) => Object.keys(run.summary.timings_seconds)))];
  const most = Math.max(...runs.flatMap((run) => Object.values(run.summary.timings_seconds)), 1e-12);
  return table(runs, [
    ...phases.map((phase): Row => [phase.replaceAll("_", " "), ...runs.map((run) => {
      const value = run.summary.timings_seconds[phase] ?? 0;
      return el("span.timing", {}, el("i", { style: `width:${(60 * value) / most}px;background:${runColour(run.number)}` }), seconds(value));
    })]),
    ["per step", ...runs.map((run) => seconds(run.summary.seconds_per_step))],
  ]);
}

function messages(runs: Run[]): HTMLElement {
  const items = runs.flatMap((run) => {
    const { summary } = run;
    const list: [string, string][] = [];
    if (summary.message) list.push([summary.status, summary.message]);
    for (const warning of summary.warnings) list.push(["warning", warning]);
    for (const [name, check] of Object.entries(summary.checks))
      if (check.limit > 0 && toNumber(check.largest) > check.limit) list.push(["check failed", `${name} reaches ${number(check.largest, 2)}, above its limit ${number(check.limit, 2)}`]);
    for (const expected of summary.expectations)
      if (expected.checked && !expected.holds) list.push(["expectation does not hold", `${expected.quantity} is ${number(expected.value)}, expected ${expected.wanted}`]);
    for (const sentence of run.data.thinned) list.push(["note", sentence]);
    return list.map(([kind, text]) => el("li", {}, el("b", { style: `color:${runColour(run.number)}` }, run.name), ` ${kind}: `, text));
  });
  if (items.length === 0) return el("p.note", {}, "None.");
  return el("ul.messages", { id: "messages" }, ...items);
}

function outcomes(runs: Run[]): HTMLElement {
  const rows: Row[] = [];
  const names = [...new Set(runs.flatMap((run) => Object.keys(run.summary.checks)))];
  for (const name of names)
    rows.push([`account of ${name.replaceAll("_", " ")} closes to`, ...runs.map((run) => {
      const check = run.summary.checks[name];
      return check ? `${number(check.largest, 2)}${check.limit > 0 ? ` (limit ${number(check.limit, 2)})` : ""}` : "–";
    })]);
  rows.push(["expectations that hold", ...runs.map((run) => {
    const checked = run.summary.expectations.filter((e) => e.checked);
    return checked.length === 0 ? "none" : `${checked.filter((e) => e.holds).length} of ${checked.length}`;
  })]);
  for (const name of [...new Set(runs.flatMap((run) => run.summary.probes.map((probe) => probe.name)))])
    rows.push([`position of probe ${name}`, ...runs.map((run) => {
      const probe = run.summary.probes.find((p) => p.name === name);
      return probe ? `(${probe.position.map((x) => number(x)).join(", ")})` : "–";
    })]);
  return table(runs, rows);
}

export function details(store: Store): HTMLElement {
  const { runs } = store;
  const place = el("div.details");
  const fill = () => {
    const open = [...place.querySelectorAll("details")].map((each) => each.open);
    const several = runs.reduce((sum, run) => sum + run.summary.warnings.length + run.data.thinned.length, 0);
    place.replaceChildren(
      section(`Warnings and messages${several > 0 ? ` (${several})` : ""}`, open[0] ?? true, messages(runs)),
      section("Impacts", open[1] ?? runs.length === 1, impactTable(runs) ?? el("p.note", {}, "No impact is recorded.")),
      section("Inputs", open[2] ?? true, inputs(runs)),
      section("Sizes", open[3] ?? false, sizes(runs)),
      section("Timings by phase", open[4] ?? false, timings(runs)),
      section("Checks, expectations, probes", open[5] ?? false, outcomes(runs)),
    );
  };
  fill();
  store.on("theme", fill);
  return place;
}
