import type { Run } from "./data/run";
import type { Judgement, Summary } from "./data/types";
import { el } from "./elements";
import { columnName, number, toNumber } from "./format";

/** Verdicts on each run in words, at the top of the page. */

export type Grade = "good" | "fair" | "poor" | "none";

export interface Finding {
  what: string;
  grade: Grade;
  words: string;
  /** For cells of a table; the tooltip has the full text. */
  short: string;
  detail: string;
}

const percent = (value: number) => `${number(100 * value, value >= 0.1 ? 3 : 2)} %`;

const broken = (what: string, time: number): Finding => ({ what, grade: "poor", words: `not finite from t = ${number(time)} on`, short: "not finite", detail: "infinite or NaN" });

/** Sums and depths of finite numbers can overflow. */
const unbounded = (what: string): Finding => ({ what, grade: "poor", words: "not finite", short: "not finite", detail: "infinite or NaN" });
const finite = (...values: (number | null)[]) => values.every((value) => value === null || Number.isFinite(value));

/** The acting reactions in words; "" if the scheme has no choice. */
export function reactionsWords({ reactions }: Summary): string {
  if (!reactions) return "";
  if (reactions.acting === "end") return "those at the end of the step";
  const { steps_of_means: means, steps_without_mean: ends } = reactions;
  if (means + ends === 0) return "mean (no contact occurred)";
  const [least, largest] = [reactions.least_end_weight, reactions.largest_end_weight].map((weight) => number(weight, 2));
  const weights = means === 0 ? "" : `, end weight ${least === largest ? least : `${least} to ${largest}`}`;
  return `mean${weights}${ends === 0 ? "" : `; those at the end of the step in ${ends} of ${means + ends} steps`}`;
}

/** Scheme, mass and acting reactions of a run, for its card. */
export function methodWords(summary: Summary): string {
  const reactions = reactionsWords(summary);
  return `${summary.scheme}, ${summary.mass} mass${reactions === "" ? "" : `; reactions: ${reactions}`}`;
}

interface EnergyChange {
  gain: number;
  loss: number;
  /** The energy that gain and loss are fractions of, in words. */
  whole: string;
}

/** Change of the energy if only contact acts on the body; otherwise the change by the method, from the budget over all steps if the run has one. */
function energyChange(j: Judgement, { energy_budget: budget }: Summary): EnergyChange {
  if (!j.is_isolated && budget) return { gain: toNumber(budget.created_by_method), loss: toNumber(budget.lost_by_method), whole: "the largest energy" };
  return { gain: j.energy_gain / j.energy_scale, loss: j.energy_loss / j.energy_scale, whole: "the energy at the start" };
}

const budgetWords = ({ energy_budget: budget }: Summary): string =>
  budget ? `; the method created at most ${percent(toNumber(budget.created_by_method))} and lost at most ${percent(toNumber(budget.lost_by_method))} of the largest energy` : "";

/** Corrections of the velocities that a user should know of; "" if there are none. */
function correctionWords({ velocity_corrections: found, steps }: Summary): string {
  if (!found || found.steps === 0) return "";
  return `; corrections of velocities to close the balance changed up to ${percent(toNumber(found.largest))} of the energy in a step, and too much in ${found.steps} of ${steps} steps`;
}

export function energyFinding(j: Judgement, summary: Summary): Finding {
  const what = j.is_isolated ? "Energy" : "Energy in contact";
  if (j.energy_broken_at !== null) return broken(what, j.energy_broken_at);
  if (!finite(j.energy_scale, j.energy_gain, j.energy_loss)) return unbounded(what);
  if (!(j.energy_scale > 0)) return { what, grade: "none", words: "the body has no energy", short: "none", detail: "" };
  const { gain, loss, whole } = energyChange(j, summary);
  const source = j.is_isolated ? "total energy" : "contact work less numerical dissipation";
  const detail = `${source} relative to ${whole}: rises by ${number(gain, 3)}, falls by ${number(loss, 3)}${budgetWords(summary)}${correctionWords(summary)}; the energy account closes to ${number(j.energy_residual / j.energy_scale, 2)}`;
  const finding = (grade: Grade, words: string, short = words): Finding => ({ what, grade, words, short, detail });
  if (gain > 0.02) return finding("poor", gain > 1 ? `created: up to ${number(1 + gain, 3)} times the initial energy` : `created: +${percent(gain)}`);
  if (correctionWords(summary) !== "" && gain <= 0.005 && loss < 0.01) return finding("fair", "conserved with large corrections of velocities", "large corrections");
  if (Math.max(gain, loss) < 1e-8) return finding("good", "conserved to rounding", "conserved");
  if (gain > loss) return finding(gain > 0.005 ? "fair" : "good", `conserved to within +${percent(gain)}`, `+${percent(gain)}`);
  return finding(loss < 0.01 ? "good" : "fair", loss < 0.01 ? `conserved to within ${percent(loss)}` : `the method lost ${percent(loss)}`, `−${percent(loss)}`);
}

/** Largest share of a contact's force at stake, where frozen steps have left gaps, up to which the force is reliable. */
const doubtful = 0.01;

/** The contact with the largest share of its force at stake, among those with large sliding; null if no share is too large. */
function doubtfulContact({ unsettled_contacts: contacts }: Summary) {
  const [worst] = [...contacts].sort((a, b) => toNumber(b.share_of_force) - toNumber(a.share_of_force));
  return worst && toNumber(worst.share_of_force) > doubtful ? worst : null;
}

export function forceFinding(j: Judgement, summary: Summary): Finding {
  const what = "Contact force";
  if (j.force_broken_at !== null) return broken(what, j.force_broken_at);
  if (!finite(j.force_largest, j.force_variation, j.trend_variation, j.node_roughness)) return unbounded(what);
  if (!(j.force_largest > 0)) return { what, grade: "none", words: "none", short: "none", detail: "no contact occurred" };
  const most = `up to ${number(j.force_largest, 3)}`;
  const detail = `force of all contacts together, largest at t = ${number(j.force_largest_at)}; total variation of ${columnName(j.force)}: ${number(j.force_variation, 3)}, of its running mean over a hundredth of the run (at least 11 rows): ${number(j.trend_variation, 3)}`;
  const doubt = doubtfulContact(summary);
  if (doubt) {
    const share = percent(toNumber(doubt.share_of_force));
    return { what, grade: "poor", words: `${most}, in doubt: up to ${share} of the force of contact ${doubt.contact} is at stake where frozen steps have left gaps`, short: `in doubt, ${share}`, detail: `gap ${number(toNumber(doubt.gap), 3)}, in ${doubt.steps} steps from t = ${number(toNumber(doubt.first_time))} on, in which the pairing of the two sides did not settle; ${detail}` };
  }
  if (!(j.roughness > 0)) return { what, grade: "none", words: `${most}; too few rows to judge its smoothness`, short: "too few rows", detail };
  const ofNode = j.node_roughness >= 2 && j.node_roughness > 2 * j.roughness;
  const roughness = ofNode ? j.node_roughness : j.roughness;
  const at = ofNode ? ` at ${columnName(j.node_force).split(":")[0]}` : "";
  if (roughness < 2) return { what, grade: "good", words: `${most}, smooth`, short: "smooth", detail };
  const name = roughness < 6 ? "ripples" : "rattles";
  const words = `${name}${at}: ${number(roughness, 2)} times the variation of its running mean`;
  return { what, grade: roughness < 6 ? "fair" : "poor", words: `${most}, ${words}`, short: `${name}, ${number(roughness, 2)} ×`, detail };
}

export function penetrationFinding(j: Judgement): Finding {
  const what = "Interpenetration";
  if (j.penetration_broken_at !== null) return broken(what, j.penetration_broken_at);
  const relative = j.relative_penetration;
  if (!finite(j.penetration, relative)) {
    const where = j.unwatched_penetration === "" ? "" : `${j.unwatched_penetration}, where no contact prevents it; `;
    return { ...unbounded(what), words: "infinitely deep", detail: `${where}infinite or NaN` };
  }
  const share = relative === null ? `${number(j.penetration, 3)} deep` : percent(relative);
  const size = relative === null ? `${number(j.penetration, 3)} deep` : `${percent(relative)} of the body's size`;
  if (j.unwatched_penetration !== "") {
    return { what, grade: "poor", words: `${size}, where no contact prevents it`, short: `${share}, not prevented`, detail: `${j.unwatched_penetration}: depth up to ${number(j.penetration, 3)}; see the warnings for position and time` };
  }
  const detail = relative === null
    ? `depth up to ${number(j.penetration, 3)}; the body's size is unknown, as the run wrote no fields`
    : `depth up to ${number(j.penetration, 3)}, ${number(relative, 2)} of the body's size`;
  const none = relative === null ? j.penetration === 0 : relative < 1e-9;
  if (j.penetration_not_watched !== "") {
    return { what, grade: "none", words: `${none ? "none" : size} where checked; not checked: ${j.penetration_not_watched}`, short: `${none ? "none" : share}, partly checked`, detail: `${detail}; not checked: ${j.penetration_not_watched}` };
  }
  if (j.contact_beyond_rim !== "") return { what, grade: "fair", words: "contact extends beyond its group", short: "beyond its group", detail: `group "${j.contact_beyond_rim}" is in contact at its rim; ${detail}` };
  if (none) return { what, grade: "good", words: "none", short: "none", detail };
  if (relative === null) return { what, grade: "none", words: size, short: share, detail };
  return { what, grade: relative < 1e-5 ? "good" : relative < 0.01 ? "fair" : "poor", words: size, short: share, detail };
}

const turnsTooFar = (j: Judgement): boolean => j.rotation_limit !== null && j.rotation > j.rotation_limit;

/** Whether rotations affect the results of impacts: those after the last impact do not. */
export const turnsInImpacts = (j: Judgement): boolean => turnsTooFar(j) && !j.rotation_after_impacts;

export function rotationFinding(j: Judgement): Finding {
  const what = "Rotation";
  if (!finite(j.rotation)) return unbounded(what);
  const strain = 1 - Math.cos(Math.min(j.rotation, Math.PI));
  const detail = j.rotation_limit === null
    ? "largest rotation of a cell; the material laws are those of finite strain and hold for any rotation"
    : `largest rotation of a cell; under small strain a rotation θ causes a spurious strain of 1 − cos θ, here ${number(strain, 2)}`;
  const short = `${number(j.rotation, 2)} rad`;
  if (!turnsTooFar(j)) return { what, grade: "good", words: short, short, detail };
  if (j.rotation_after_impacts) return { what, grade: "fair", words: `${short}, but at most ${number(j.rotation_limit!)} rad until the end of the last impact`, short, detail: `${detail}; the results of the impacts are not affected` };
  return { what, grade: "poor", words: `${short}: small strain does not hold (spurious strain of ${percent(strain)})`, short, detail };
}

export const findings = (run: Run): Finding[] => [
  energyFinding(run.data.judgement, run.summary),
  forceFinding(run.data.judgement, run.summary),
  penetrationFinding(run.data.judgement),
  rotationFinding(run.data.judgement),
];

export const marks: Record<Grade, [string, string]> = {
  good: ["✓", "good"],
  fair: ["~", "fair"],
  poor: ["✗", "poor"],
  none: ["·", "no verdict"],
};

export function findingsElement(run: Run): HTMLElement {
  return el("dl.findings", {}, ...findings(run).flatMap(({ what, grade, words, detail }) => [
    el("dt", {}, what),
    el("dd", { className: grade, title: detail }, markElement(grade), words),
  ]));
}

/** Entries that may differ between runs of one problem by different methods. */
const methods = /^(time|mass|solver|output|check|expect|probe)\b|^mesh\.degree$|multipliers$|^title$/;

const sameProblem = (runs: Run[]): boolean => {
  const keys = new Set(runs.flatMap((run) => Object.keys(run.summary.parameters)));
  return [...keys].every((key) => methods.test(key) || new Set(runs.map((run) => run.summary.parameters[key])).size === 1);
};

/** A mark, with a label for screen readers. */
export const markElement = (grade: Grade) => el("span.mark", { role: "img", "aria-label": marks[grade][1] }, marks[grade][0]);

/** Recommendation among several runs; "" if there is none. */
export function conclusion(runs: Run[]): string {
  if (runs.length < 2 || !sameProblem(runs)) return "";
  const ends = runs.map((run) => run.summary.end_time);
  if (runs.some((run) => run.summary.status !== "done") || Math.max(...ends) > 1.01 * Math.min(...ends)) return "";
  const all = runs.map(findings);
  // A missing verdict rules out a recommendation.
  if (all.some((each) => each.some(({ grade }) => grade === "none"))) return "";
  // Beyond small strain even the best method solves another problem.
  const turned = runs.filter((run) => turnsInImpacts(run.data.judgement));
  if (turned.length > 0) {
    const names = turned.length === runs.length ? "all of these runs" : turned.map((run) => run.name).join(", ");
    return `No recommendation: in ${names} cells rotate by more than ${number(turned[0].data.judgement.rotation_limit!)} rad, and small strain does not hold.`;
  }
  const points = { good: 0, none: 0, fair: 1, poor: 3 };
  const scores = all.map((each) => each.reduce((sum, { grade }) => sum + points[grade], 0));
  const best = Math.min(...scores);
  const winners = runs.filter((_, i) => scores[i] === best);
  if (winners.length === runs.length) return best === 0 ? "All runs conserve energy, with a smooth contact force and without interpenetration." : "";
  if (winners.length > 3) return "";
  const names = winners.map((run) => `${run.name} (${run.summary.mass} mass)`).join(" and ");
  if (best === 0) return `Use ${names}: energy is conserved, the contact force is smooth, and nothing interpenetrates.`;
  return `Best of these runs: ${names}.`;
}
