import { runColour } from "../colours";
import type { Run } from "../data/run";
import type { Impact, PeakStress, Value } from "../data/types";
import { el } from "../elements";
import { number, toNumber } from "../format";
import { markElement } from "../glance";
import { restitutionRemark } from "./restitution";

/** Results of a run: its impacts and its largest stress. */

const bodyName = (run: Run, number: number) => run.summary.bodies[number].name;

/** Name of the obstacle or of the other body. */
const opponent = (run: Run, { obstacle, against }: Impact): string => (against ? bodyName(run, against.body) : obstacle ?? "");

/** Spin of a body; in space its magnitude. */
export function spin(value: Value | Value[]): number {
  return Array.isArray(value) ? Math.hypot(...value.map(toNumber)) : toNumber(value);
}

const place = (peak: PeakStress, dimension: number) => `(${peak.place.slice(0, dimension).map((x) => number(x, 3)).join(", ")})`;

/** Whether a body rotates during the impact by more than 10⁻⁴ rad; less is insignificant. */
const turns = ({ spin_before, spin_after }: Pick<Impact, "spin_before" | "spin_after">, { duration }: Impact) => Math.max(Math.abs(spin(spin_before)), Math.abs(spin(spin_after))) * duration > 1e-4;

/** The normal impulse, and the impulse of all contact forces if friction makes it differ in the digits shown. */
function impulseWords({ impulse, normal_impulse }: Impact): string {
  const normal = number(normal_impulse, 3);
  const whole = number(spin(impulse), 3);
  return `normal impulse ${normal}${whole !== normal ? ` (with friction ${whole})` : ""}`;
}

/** Restitution as text; "" if there is none. */
export function restitutionText({ restitution }: Impact): string {
  const value = toNumber(restitution);
  return Number.isFinite(value) ? value.toFixed(3).replace("-", "−") : "";
}

const coarseZone = "The contact zone is too coarse for a reliable largest force and duration. Refine the mesh there.";

const pointWords = ({ contact_points: carrying, all_contact_points: all }: Impact): string => (carrying ? `${carrying} of ${all}` : "");

/** The results of an impact in words, without the restitution. */
export function impactWords(run: Run, impact: Impact): string {
  const parts: string[] = [];
  if (!impact.ended) parts.push("not ended");
  parts.push(`duration ${impact.ended ? "" : "so far "}${number(impact.duration, 3)}`, impulseWords(impact), `largest force ${number(impact.largest_force, 3)}`);
  const bodies: Pick<Impact, "body" | "spin_before" | "spin_after">[] = [impact, ...(impact.against ? [impact.against] : [])];
  for (const body of bodies.filter((each) => impact.ended && turns(each, impact))) {
    const spins = [spin(body.spin_before), spin(body.spin_after)];
    const least = 1e-6 * Math.max(...spins.map(Math.abs)); // smaller values are rounding
    parts.push(`spin ${impact.against ? `of ${bodyName(run, body.body)} ` : ""}${spins.map((value) => (Math.abs(value) < least ? "0" : number(value, 3))).join(" → ")}`);
  }
  return parts.join(", ");
}

function restitutionParts(run: Run, impact: Impact): (HTMLElement | string)[] {
  const text = restitutionText(impact);
  if (text === "") return impact.ended && impact.why_no_restitution ? [`no restitution (${impact.why_no_restitution}), `] : [];
  const remark = restitutionRemark(run, impact);
  if (!remark) return [`restitution ${text}, `];
  return [`restitution ${text} `, el(`strong.${remark.grade}`, { title: remark.detail }, markElement(remark.grade), `(${remark.words})`), ", "];
}

const mostOnCard = 3;

/** Lines of a run's card. `show` moves the page to a time, or to the largest stress. */
export function outcomeElements(run: Run, show: { time: (time: number) => void; peak: () => void }): HTMLElement[] {
  const { impacts, impacts_left_out: leftOut, peak_stress: peak, dimension } = run.summary;
  const result: HTMLElement[] = [];
  impacts.slice(0, mostOnCard).forEach((impact, i) => {
    const name = impacts.length > 1 ? `Impact ${i + 1}` : "Impact";
    const when = `t = ${number(impact.begin, 4)}${impact.from_start ? " (from the start)" : ""}`;
    result.push(el("dt", {}, name), el("dd.outcome", { title: `${impact.against ? `${bodyName(run, impact.body)} and ${opponent(run, impact)}` : `On ${opponent(run, impact)}`}, from ${when}. docs/impacts.md explains how impacts are separated.` },
      el("button.link", { type: "button", onclick: () => show.time(impact.largest_force_time) }, when), ": ", ...restitutionParts(run, impact), impactWords(run, impact),
      ...(impact.coarse ? [" ", el("strong.fair", { title: coarseZone }, markElement("fair"), `(at most ${pointWords(impact)} contact points at once: too coarse)`)] : [])));
  });
  const more = impacts.length - mostOnCard + leftOut;
  if (more > 0) result.push(el("dt"), el("dd.outcome", {}, el("a", { href: "#impacts" }, `and ${more} more`)));
  if (peak && Number.isFinite(toNumber(peak.von_mises))) {
    const all = peak.states_looked_at >= peak.states;
    result.push(el("dt", {}, "Largest stress"), el("dd.outcome", { title: all ? "von Mises stress of all steps" : `von Mises stress; ${peak.states_looked_at} of ${peak.states} states were evaluated, and it may be higher in between` },
      `${all ? "" : "≥ "}${number(peak.von_mises, 4)} `, el("button.link", { type: "button", onclick: () => show.peak() }, `at t = ${number(peak.time, 4)}, ${place(peak, dimension)}`),
      ...(peak.sits_on ? [" ", el("strong.fair", { title: "The stress of linear elasticity is infinite there: the value depends on the mesh and does not characterize the body. Round the edge, or evaluate the stress elsewhere." }, markElement("fair"), `(grows with refinement: it sits on ${peak.sits_on})`)] : [])));
  }
  return result;
}

const columns: [string, (impact: Impact, run: Run) => string | HTMLElement][] = [
  ["obstacle or other body", (impact, run) => opponent(run, impact)],
  ["body", ({ body }, run) => bodyName(run, body)],
  ["begin", ({ begin, from_start }) => `${number(begin, 5)}${from_start ? " (start)" : ""}`],
  ["duration", ({ duration, ended }) => `${number(duration, 4)}${ended ? "" : " so far"}`],
  ["restitution", (impact, run) => {
    const remark = restitutionRemark(run, impact);
    const text = number(impact.restitution, 4);
    if (impact.ended && impact.why_no_restitution) return el("span", { title: impact.why_no_restitution }, "none");
    return remark ? el(`span.${remark.grade}`, { title: `${remark.words}; ${remark.detail}` }, markElement(remark.grade), text) : text;
  }],
  ["normal speed before", ({ normal_velocity_before }) => number(normal_velocity_before, 4)],
  ["after", ({ normal_velocity_after }) => number(normal_velocity_after, 4)],
  ["normal impulse", ({ normal_impulse }) => number(normal_impulse, 4)],
  ["largest force", ({ largest_force }) => number(largest_force, 4)],
  ["contact points", (impact) => (impact.coarse ? el("span.fair", { title: coarseZone }, markElement("fair"), pointWords(impact)) : pointWords(impact))],
  ["time of the largest force", ({ largest_force_time }) => number(largest_force_time, 5)],
  ["spin before", ({ spin_before }) => number(spin(spin_before), 4)],
  ["after", ({ spin_after }) => number(spin(spin_after), 4)],
  ["kinetic energy, after / before", ({ kinetic_energy_ratio }) => number(kinetic_energy_ratio, 4)],
];

/** Table of all impacts of all runs, a row for each. */
export function impactTable(runs: Run[]): HTMLElement | null {
  if (runs.every((run) => run.summary.impacts.length === 0)) return null;
  const rows = runs.flatMap((run) => run.summary.impacts.map((impact) =>
    el("tr", {}, el("th", { scope: "row", style: `color:${runColour(run.number)}` }, run.name), ...columns.map(([, text]) => el("td", {}, text(impact, run))))));
  const leftOut = runs.filter((run) => run.summary.impacts_left_out > 0).map((run) => `${run.name}: ${run.summary.impacts_left_out} later impacts`);
  return el("div.table", { id: "impacts" },
    el("table", {}, el("thead", {}, el("tr", {}, el("th"), ...columns.map(([name]) => el("th", { scope: "col" }, name)))), el("tbody", {}, ...rows)),
    leftOut.length > 0 && el("p.note", {}, `Counted, but not listed: ${leftOut.join("; ")}.`));
}
