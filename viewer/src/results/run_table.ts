import { runColour } from "../colours";
import type { Run } from "../data/run";
import { el } from "../elements";
import { findings, markElement } from "../glance";
import { number, toNumber } from "../format";
import type { Store } from "../store";
import { impactWords, restitutionText } from "./outcomes";
import { differingParameters } from "./parameters";
import { restitutionRemark } from "./restitution";

function restitutionCell(run: Run): HTMLElement {
  const impact = run.summary.impacts[0];
  const remark = impact && restitutionRemark(run, impact);
  const text = (impact && restitutionText(impact)) || "–";
  return remark ? el(`td.${remark.grade}`, { title: `${remark.words}; ${remark.detail}` }, markElement(remark.grade), text) : el("td", {}, text);
}

const largestForce = (run: Run): string => {
  const { force_broken_at: brokenAt, force_largest: most } = run.data.judgement;
  return brokenAt === null ? number(most, 4) : "–";
};

/** The largest stress, with "≥" if not every step was evaluated. */
function stressCell(run: Run): HTMLElement {
  const peak = run.summary.peak_stress;
  if (!peak || !Number.isFinite(toNumber(peak.von_mises))) return el("td", {}, number(peak?.von_mises ?? null));
  const all = peak.states_looked_at >= peak.states;
  return el("td", { title: `von Mises stress${all ? " of all steps" : "; not every step was evaluated"}` }, `${all ? "" : "≥ "}${number(peak.von_mises, 4)}`);
}

/** Table for many runs: a row for each, with the entries that vary, results and verdicts. */
export function runTable(store: Store, runs: Run[]): HTMLElement {
  const parameters = differingParameters(runs).slice(0, 4);
  const impacts = runs.some((run) => run.summary.impacts.length > 0);
  const stress = runs.some((run) => run.summary.peak_stress);
  const titles = [...new Set(runs.flatMap((run) => findings(run).map(({ what }) => what)))];
  // Results precede words, because a screen is narrower than the table.
  const head = el("tr", {}, ...["run", ...parameters.map(({ name }) => name), ...(impacts ? ["restitution"] : []), "largest force", ...(stress ? ["largest stress"] : []), ...titles, ...(impacts ? ["first impact"] : []), ""]
    .map((text) => el("th", { scope: "col", title: text === "restitution" ? "of the first impact" : "" }, text)));
  const rows = runs.map((run, i) => {
    const swatch = el("i");
    const button = el("button.toggle", { type: "button", title: `Show or hide ${run.name}. Shift-click shows this run alone.`, onclick: (event: MouseEvent) => (event.shiftKey ? store.only(run.number) : store.toggle(run.number)) }, swatch, run.name);
    const found = findings(run);
    const cells = titles.map((title) => {
      const finding = found.find(({ what }) => what === title);
      if (!finding) return el("td", {}, "–");
      return el(`td.${finding.grade}`, { title: `${finding.words}; ${finding.detail}` }, markElement(finding.grade), finding.short);
    });
    const { status, warnings } = run.summary;
    const remarks = [status !== "done" && status, warnings.length > 0 && `${warnings.length} ${warnings.length === 1 ? "warning" : "warnings"}`].filter((each) => each !== false);
    const row = el("tr.card", {}, el("td", {}, button), ...parameters.map(({ texts }) => el("td", {}, texts[i])),
      impacts && restitutionCell(run), el("td", {}, largestForce(run)), stress && stressCell(run), ...cells,
      impacts && el("td", {}, run.summary.impacts[0] ? impactWords(run, run.summary.impacts[0]) : "–"),
      el("td", {}, remarks.length > 0 && el("a.warned", { href: "#messages" }, remarks.join(", "))));
    row.addEventListener("pointerenter", () => store.setHighlight(run.number));
    row.addEventListener("pointerleave", () => store.setHighlight(null));
    return { run, swatch, button, row };
  });
  const show = () => {
    for (const { run, swatch, button, row } of rows) {
      swatch.style.background = runColour(run.number);
      row.classList.toggle("off", !store.visible[run.number]);
      button.setAttribute("aria-pressed", String(store.visible[run.number]));
    }
  };
  store.on("runs", show);
  store.on("theme", show);
  show();
  return el("div.runs.panel", {}, el("table", {}, el("thead", {}, head), el("tbody", {}, ...rows.map(({ row }) => row))));
}
