import type { Run } from "./data/run";
import type { Judgement, Summary } from "./data/types";
import { el } from "./elements";
import { columnName, number, toNumber } from "./format";

/** What came out of each run, in words: the first thing that a reader sees. */

export type Grade = "good" | "fair" | "poor" | "none";

export interface Finding {
  what: string;
  grade: Grade;
  words: string;
  /** For a table, whose tips tell the rest. */
  short: string;
  detail: string;
}

const percent = (value: number) => `${number(100 * value, value >= 0.1 ? 3 : 2)} %`;

const broken = (what: string, time: number): Finding => ({ what, grade: "poor", words: `no number from t = ${number(time)} on`, short: "no number", detail: "infinite, or not a number" });

/** Sums and depths of numbers that are finite can still be infinite. */
const unbounded = (what: string): Finding => ({ what, grade: "poor", words: "beyond all numbers", short: "infinite", detail: "infinite, or not a number" });
const finite = (...values: (number | null)[]) => values.every((value) => value === null || Number.isFinite(value));

/** Which reactions act over a step, in words; "": the scheme has no choice. */
export function reactionsWords({ reactions }: Summary): string {
  if (!reactions) return "";
  if (reactions.acting === "end") return "those of the end of a step";
  const { steps_of_means: means, steps_without_mean: ends } = reactions;
  if (means + ends === 0) return "mean, but none acted";
  const [least, largest] = [reactions.least_end_weight, reactions.largest_end_weight].map((weight) => number(weight, 2));
  const weights = means === 0 ? "" : `, end weight ${least === largest ? least : `${least} to ${largest}`}`;
  return `mean${weights}${ends === 0 ? "" : `, those of the end in ${ends} of ${means + ends} steps`}`;
}

/** Of a card: what ran. */
export function methodWords(summary: Summary): string {
  const reactions = reactionsWords(summary);
  return `${summary.scheme}, ${summary.mass} mass${reactions === "" ? "" : `; reactions: ${reactions}`}`;
}

interface EnergyChange {
  gain: number;
  loss: number;
  /** What the parts are parts of. */
  whole: string;
}

/** Where loads or friction change the energy, what the method does to it is looked at: by every step, if the run says. */
function energyChange(j: Judgement, { energy_budget: budget }: Summary): EnergyChange {
  if (!j.is_isolated && budget) return { gain: toNumber(budget.created_by_method), loss: toNumber(budget.lost_by_method), whole: "the largest energy" };
  return { gain: j.energy_gain / j.energy_scale, loss: j.energy_loss / j.energy_scale, whole: j.is_isolated ? "that of the start" : "the energy of the start" };
}

const budgetWords = ({ energy_budget: budget }: Summary): string =>
  budget ? `; of the largest energy the method created ${percent(toNumber(budget.created_by_method))} and lost ${percent(toNumber(budget.lost_by_method))} at most` : "";

export function energyFinding(j: Judgement, summary: Summary): Finding {
  const what = j.is_isolated ? "Energy" : "Energy in contact";
  if (j.energy_broken_at !== null) return broken(what, j.energy_broken_at);
  if (!finite(j.energy_scale, j.energy_gain, j.energy_loss)) return unbounded(what);
  if (!(j.energy_scale > 0)) return { what, grade: "none", words: "there is none", short: "none", detail: "" };
  const { gain, loss, whole } = energyChange(j, summary);
  const source = j.is_isolated ? "total energy" : "contact work less numerical dissipation";
  const detail = `${source} against ${whole}: rises by ${number(gain, 3)}, falls by ${number(loss, 3)} of it${budgetWords(summary)}; the account closes to ${number(j.energy_residual / j.energy_scale, 2)}`;
  const finding = (grade: Grade, words: string, short = words): Finding => ({ what, grade, words, short, detail });
  if (gain > 0.02) return finding("poor", gain > 1 ? `created: ${number(1 + gain, 3)} times what there was` : `created: +${percent(gain)}`);
  if (Math.max(gain, loss) < 1e-8) return finding("good", "kept to rounding", "kept");
  if (gain > loss) return finding(gain > 0.005 ? "fair" : "good", `kept, but for +${percent(gain)}`, `+${percent(gain)}`);
  return finding(loss < 0.01 ? "good" : "fair", loss < 0.01 ? `kept, but for ${percent(loss)}` : `the method lost ${percent(loss)}`, `−${percent(loss)}`);
}

/** Above this share of its force on points that held steps have left at a gap a contact is not to be trusted. */
const doubtful = 0.01;

/** The contact whose force is most in doubt, of those that slide far. */
function doubtfulContact({ unsettled_contacts: contacts }: Summary) {
  const [worst] = [...(contacts ?? [])].sort((a, b) => toNumber(b.share_of_force) - toNumber(a.share_of_force));
  return worst && toNumber(worst.share_of_force) > doubtful ? worst : null;
}

export function forceFinding(j: Judgement, summary: Summary): Finding {
  const what = "Contact force";
  if (j.force_broken_at !== null) return broken(what, j.force_broken_at);
  if (!finite(j.force_largest, j.force_variation, j.trend_variation, j.node_roughness)) return unbounded(what);
  if (!(j.force_largest > 0)) return { what, grade: "none", words: "none", short: "none", detail: "nothing touched" };
  const most = `up to ${number(j.force_largest, 3)}`;
  const detail = `all contacts together; largest at t = ${number(j.force_largest_at)}. ${columnName(j.force)}: its total variation is ${number(j.force_variation, 3)}, that of its mean over a hundredth of the run (11 rows at least) ${number(j.trend_variation, 3)}`;
  const doubt = doubtfulContact(summary);
  if (doubt) {
    const share = percent(toNumber(doubt.share_of_force));
    return { what, grade: "poor", words: `${most}, in doubt: up to ${share} of that of contact ${doubt.contact} is at stake where held steps have left gaps`, short: `in doubt, ${share}`, detail: `gap ${number(toNumber(doubt.gap), 3)}, in ${doubt.steps} steps from t = ${number(toNumber(doubt.first_time))} on, where what faces what did not settle; ${detail}` };
  }
  if (!(j.roughness > 0)) return { what, grade: "none", words: `${most}; too few rows to tell whether it is smooth`, short: "too few rows", detail };
  const ofNode = j.node_roughness >= 2 && j.node_roughness > 2 * j.roughness;
  const roughness = ofNode ? j.node_roughness : j.roughness;
  const place = ofNode ? `: at ${columnName(j.node_force).split(":")[0]} it` : ":";
  if (roughness < 2) return { what, grade: "good", words: `${most}, smooth`, short: "smooth", detail };
  const name = roughness < 6 ? "ripples" : "rattles";
  const words = `${name}${place} varies ${number(roughness, 2)} times as much as its trend`;
  return { what, grade: roughness < 6 ? "fair" : "poor", words: `${most}, ${words}`, short: `${name}, ${number(roughness, 2)} ×`, detail };
}

export function penetrationFinding(j: Judgement): Finding {
  const what = "Interpenetration";
  if (j.penetration_broken_at !== null) return broken(what, j.penetration_broken_at);
  const relative = j.relative_penetration;
  if (!finite(j.penetration, relative)) {
    const where = j.unwatched_penetration === "" ? "" : `${j.unwatched_penetration}, where no contact prevents it; `;
    return { ...unbounded(what), words: "infinitely deep", detail: `${where}infinite, or not a number` };
  }
  const share = relative === null ? `${number(j.penetration, 3)} deep` : percent(relative);
  const size = relative === null ? `${number(j.penetration, 3)} deep` : `${percent(relative)} of the body's size`;
  if (j.unwatched_penetration !== "") {
    return { what, grade: "poor", words: `${size}, where no contact prevents it`, short: `${share}, unprevented`, detail: `${j.unwatched_penetration}: deepest ${number(j.penetration, 3)}; warnings say where and when` };
  }
  const detail = relative === null
    ? `deepest ${number(j.penetration, 3)}; the run wrote no fields: the body's size is not known`
    : `deepest ${number(j.penetration, 3)}, ${number(relative, 2)} of the body's size`;
  const none = relative === null ? j.penetration === 0 : relative < 1e-9;
  if (!j.penetration_checked) {
    return { what, grade: "none", words: `${none ? "none" : size} at contact points, elsewhere not checked`, short: `${none ? "none" : share}, not all checked`, detail: `${detail}; results of a version that looked at contact points only` };
  }
  if (j.penetration_not_watched !== "") {
    return { what, grade: "none", words: `${none ? "none" : size} where it was watched; not watched: ${j.penetration_not_watched}`, short: `${none ? "none" : share}, not all watched`, detail: `${detail}; not watched: ${j.penetration_not_watched}` };
  }
  if (j.contact_beyond_rim !== "") return { what, grade: "fair", words: "contact goes on beyond its group", short: "beyond its group", detail: `group "${j.contact_beyond_rim}" is in contact at its rim; ${detail}` };
  if (none) return { what, grade: "good", words: "none", short: "none", detail };
  if (relative === null) return { what, grade: "none", words: size, short: share, detail };
  return { what, grade: relative < 1e-5 ? "good" : relative < 0.01 ? "fair" : "poor", words: size, short: share, detail };
}

const turnsTooFar = (j: Judgement): boolean => j.rotation_limit !== null && j.rotation > j.rotation_limit;

/** What turns after the last impact does not change what the impacts came to. */
export const turnsInImpacts = (j: Judgement): boolean => turnsTooFar(j) && !j.rotation_after_impacts;

export function rotationFinding(j: Judgement): Finding {
  const what = "Rotation";
  if (!finite(j.rotation)) return unbounded(what);
  const strain = 1 - Math.cos(Math.min(j.rotation, Math.PI));
  const detail = j.rotation_limit === null
    ? "largest of a cell; the laws of finite strain hold for any rotation"
    : `largest of a cell; small strain takes a rotation θ for a strain of 1 − cos θ, here ${number(strain, 2)}, that is not there`;
  const short = `${number(j.rotation, 2)} rad`;
  if (!turnsTooFar(j)) return { what, grade: "good", words: short, short, detail };
  if (j.rotation_after_impacts) return { what, grade: "fair", words: `${short}, but within ${number(j.rotation_limit!)} rad until the last impact had ended`, short, detail: `${detail}; what the impacts came to is not affected` };
  return { what, grade: "poor", words: `${short}: small strain does not hold (a strain of ${percent(strain)} is not there)`, short, detail };
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
  none: ["·", "nothing to judge"],
};

export function findingsElement(run: Run): HTMLElement {
  return el("dl.findings", {}, ...findings(run).flatMap(({ what, grade, words, detail }) => [
    el("dt", {}, what),
    el("dd", { className: grade, title: detail }, markElement(grade), words),
  ]));
}

/** What may differ between runs that answer one question by different methods. */
const methods = /^(time|mass|solver|output|check|expect|probe)\b|^mesh\.degree$|multipliers$|^title$/;

const sameProblem = (runs: Run[]): boolean => {
  const keys = new Set(runs.flatMap((run) => Object.keys(run.summary.parameters)));
  return [...keys].every((key) => methods.test(key) || new Set(runs.map((run) => run.summary.parameters[key])).size === 1);
};

/** A mark that those who do not see it hear. */
export const markElement = (grade: Grade) => el("span.mark", { role: "img", "aria-label": marks[grade][1] }, marks[grade][0]);

/** The sentence that says which of several runs to trust. */
export function conclusion(runs: Run[]): string {
  if (runs.length < 2 || !sameProblem(runs)) return "";
  const ends = runs.map((run) => run.summary.end_time);
  if (runs.some((run) => run.summary.status !== "done") || Math.max(...ends) > 1.01 * Math.min(...ends)) return "";
  const all = runs.map(findings);
  // Nothing can be said of a run of which something is not known.
  if (all.some((each) => each.some(({ grade }) => grade === "none"))) return "";
  // Beyond small strain even the best method gives the answer to another question.
  const turned = runs.filter((run) => turnsInImpacts(run.data.judgement));
  if (turned.length > 0) {
    const names = turned.length === runs.length ? "all of these runs" : turned.map((run) => run.name).join(", ");
    return `No recommendation: in ${names} cells turn by more than ${number(turned[0].data.judgement.rotation_limit!)} rad, and small strain does not hold.`;
  }
  const points = { good: 0, none: 0, fair: 1, poor: 3 };
  const scores = all.map((each) => each.reduce((sum, { grade }) => sum + points[grade], 0));
  const best = Math.min(...scores);
  const winners = runs.filter((_, i) => scores[i] === best);
  if (winners.length === runs.length) return best === 0 ? "All runs keep their energy, with a smooth contact force and no interpenetration." : "";
  if (winners.length > 3) return "";
  const names = winners.map((run) => `${run.name} (${run.summary.mass} mass)`).join(" and ");
  if (best === 0) return `Use ${names}: energy kept, a smooth contact force, no interpenetration.`;
  return `The best of these: ${names}.`;
}
