import { runColour } from "../colours";
import type { Run } from "../data/run";
import { el } from "../elements";
import { findings, marks } from "../glance";
import { number } from "../format";
import type { Store } from "../store";
import { impactWords } from "./outcomes";
import { differingParameters } from "./parameters";

/** Many runs: a row for each instead of a card, with what varies and what came out. */
export function runTable(store: Store, runs: Run[]): HTMLElement {
  const parameters = differingParameters(runs).slice(0, 4);
  const impacts = runs.some((run) => run.summary.impacts.length > 0);
  const stress = runs.some((run) => run.summary.peak_stress);
  const titles = [...new Set(runs.flatMap((run) => findings(run).map(({ what }) => what)))];
  const head = el("tr", {}, ...["run", ...parameters.map(({ name }) => name), ...titles, ...(impacts ? ["first impact"] : []), ...(stress ? ["largest stress"] : []), ""].map((text) => el("th", { scope: "col" }, text)));
  const rows = runs.map((run, i) => {
    const swatch = el("i");
    const button = el("button.toggle", { type: "button", title: `Show or hide ${run.name}; with shift this run alone`, onclick: (event: MouseEvent) => (event.shiftKey ? store.only(run.number) : store.toggle(run.number)) }, swatch, run.name);
    const found = findings(run);
    const cells = titles.map((title) => {
      const finding = found.find(({ what }) => what === title);
      if (!finding) return el("td", {}, "–");
      const [mark, meaning] = marks[finding.grade];
      return el(`td.${finding.grade}`, { title: finding.detail }, el("span.mark", { role: "img", "aria-label": meaning }, mark), finding.words);
    });
    const { status, warnings } = run.summary;
    const remarks = [status !== "done" && status, warnings.length > 0 && `${warnings.length} ${warnings.length === 1 ? "warning" : "warnings"}`].filter((each) => each !== false);
    const row = el("tr.card", {}, el("td", {}, button), ...parameters.map(({ texts }) => el("td", {}, texts[i])), ...cells,
      impacts && el("td", {}, run.summary.impacts[0] ? impactWords(run.summary.impacts[0]) : "–"),
      stress && el("td", {}, number(run.summary.peak_stress?.von_mises ?? null, 4)),
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
