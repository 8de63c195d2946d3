import { extentOf } from "../charts/scale";
import { indexAt, type Run } from "../data/run";
import type { Impact } from "../data/types";
import { turnsInImpacts, type Grade } from "../glance";
import { number, toNumber } from "../format";

/** Remark on a restitution above 1: whether it is possible, and its cause; or on one below 1 that is unreliable. */
export interface RestitutionRemark {
  grade: Grade;
  words: string;
  detail: string;
}

/** Relative tolerance: smaller excesses above 1, or above the available energy, are errors of the method. */
const tolerance = 1e-3;

const acts = (run: Run, work: string): boolean => {
  const { low, high } = extentOf("", run.column(work));
  return Math.max(Math.abs(low), Math.abs(high)) > 0;
};

/** Mass in the energy of the approach: m₁m₂/(m₁ + m₂) for two free bodies, the body's own mass if the other is held. */
function approachMass(run: Run, { body, against }: Impact): number {
  const own = run.summary.bodies[body];
  const mass = toNumber(own.mass);
  if (!against) return mass;
  const opposite = run.summary.bodies[against.body];
  const other = toNumber(opposite.mass);
  if (own.held !== opposite.held) return own.held ? other : mass;
  return Number.isFinite(other) ? (mass * other) / (mass + other) : mass;
}

const squared = (vector: Impact["tangential_velocity_after"]) => (vector ?? []).map(toNumber).reduce((sum, v) => sum + v * v, 0);

/** Whether the body leaves faster than its whole energy on arrival allows. */
function exceedsEnergy(run: Run, impact: Impact): boolean {
  const mass = approachMass(run, impact);
  const at = (column: string, time: number) => run.column(column)[indexAt(run.timesOf(column), time)] ?? NaN;
  const end = impact.end ?? impact.begin;
  let available = toNumber(impact.kinetic_energy_before) + toNumber(impact.against?.kinetic_energy_before ?? 0) + at("elastic_energy", impact.begin)
    + Math.max(at("load_potential", impact.begin) - at("load_potential", end), 0);
  // Without friction, motion along the obstacle cannot become motion away from it.
  if (!impact.against && run.summary.contacts.every(({ friction, friction_bound }) => !(friction > 0) && !(friction_bound > 0)))
    available -= 0.5 * mass * Math.min(squared(impact.tangential_velocity_before), squared(impact.tangential_velocity_after));
  return 0.5 * mass * toNumber(impact.normal_velocity_after) ** 2 > (1 + tolerance) * available;
}

/** Known causes of a restitution that is too large, in words. */
function reasons(run: Run): string[] {
  const { energy_gain: gain, energy_scale: scale } = run.data.judgement;
  const result: string[] = [];
  if (gain > tolerance * scale) result.push(`${run.summary.scheme} creates energy`);
  if (turnsInImpacts(run.data.judgement)) result.push("small strain does not hold");
  return result;
}

/** Fraction of the initial energy; if a run creates more, velocities after its impacts are meaningless. */
const muchEnergy = 0.1;

/** Remark if the method changed the energy by a large part of the loss of the body. */
function inexact(run: Run, impact: Impact): RestitutionRemark | null {
  if (!impact.restitution_inexact) return null;
  const approach = 0.5 * approachMass(run, impact) * toNumber(impact.normal_velocity_before) ** 2;
  const method = toNumber(impact.method_energy) / approach;
  const body = 1 - toNumber(impact.restitution) ** 2;
  const share = (part: number) => `${number(100 * Math.abs(part), 2)} %`;
  const change = `${impact.against ? "the bodies" : "the body"} ${body < 0 ? "gained" : "lost"} ${share(body)}`;
  return { grade: "fair", words: `inexact: the method ${method < 0 ? "lost" : "created"} ${share(method)}, ${change}`,
    detail: "of the energy of the approach; use a smaller time step and smaller cells to reduce the part of the method" };
}

/** Remark on the restitution of an impact; null if there is none. */
export function restitutionRemark(run: Run, impact: Impact): RestitutionRemark | null {
  const { energy_gain: gain, energy_scale: scale } = run.data.judgement;
  if (!(toNumber(impact.restitution) > 1 + tolerance)) {
    if (!Number.isFinite(toNumber(impact.restitution))) return null;
    if (!(gain > muchEnergy * scale)) return inexact(run, impact);
    return { grade: "poor", words: `unreliable: ${reasons(run).join("; ")}`, detail: "the run creates more than a tenth of the initial energy, so the ratio is arbitrary" };
  }
  if (["load_work", "support_work", "obstacle_work"].some((work) => acts(run, work)))
    return { grade: "fair", words: "above 1: driven", detail: "loads, supports or a moving obstacle do work on the body" };
  const known = reasons(run);
  if (exceedsEnergy(run, impact))
    return { grade: "poor", words: `impossible: ${known.length > 0 ? known.join("; ") : "the results do not show the reason"}`, detail: "nothing drives the body, but it leaves with more energy than it had on arrival" };
  return { grade: "fair", words: `above 1: ${[`fed by ${acts(run, "load_potential") ? "loads, " : ""}sliding, spin or vibration`, ...known].join(", or ")}`, detail: "nothing drives the body, but its energy sufficed: other motion, strain, or the potential of loads such as gravity" };
}
