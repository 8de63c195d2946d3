import { extentOf } from "../charts/scale";
import { indexAt, type Run } from "../data/run";
import type { Impact } from "../data/types";
import { turnsInImpacts, type Grade } from "../glance";
import { number, toNumber } from "../format";

/** What a restitution above 1 means, whether it is possible, and what has made it; or why one below cannot be trusted. */
export interface RestitutionRemark {
  grade: Grade;
  words: string;
  detail: string;
}

/** Relative; what is nearer to 1, or to the energy that is there, is the error of the method. */
const tolerance = 1e-3;

const acts = (run: Run, work: string): boolean => {
  const { low, high } = extentOf("", run.column(work));
  return Math.max(Math.abs(low), Math.abs(high)) > 0;
};

/** The mass that the energy of the approach is reckoned with: of two bodies m₁m₂/(m₁ + m₂), of one that meets a held one its own. */
function approachMass(run: Run, { body, against }: Impact): number {
  const [own, opposite] = [run.summary.bodies[body], against ? run.summary.bodies[against.body] : undefined];
  const mass = toNumber(own?.mass);
  const other = against ? toNumber(opposite?.mass) : Infinity;
  if (against && Boolean(own?.held) !== Boolean(opposite?.held)) return own?.held ? other : mass;
  return Number.isFinite(other) ? (mass * other) / (mass + other) : mass;
}

const squared = (vector: Impact["tangential_velocity_before"]) => (vector ?? []).map(toNumber).reduce((sum, v) => sum + v * v, 0);

/** Whether the body leaves faster than all energy allows that it has when it arrives. */
function exceedsEnergy(run: Run, impact: Impact): boolean {
  const mass = approachMass(run, impact);
  const at = (column: string, time: number) => run.column(column)[indexAt(run.timesOf(column), time)] ?? NaN;
  const end = impact.end ?? impact.begin;
  let available = toNumber(impact.kinetic_energy_before) + toNumber(impact.against?.kinetic_energy_before ?? 0) + at("elastic_energy", impact.begin)
    + Math.max(at("load_potential", impact.begin) - at("load_potential", end), 0);
  // Without friction nothing turns the motion along the obstacle into one away from it.
  if (!impact.against && run.summary.contacts.every(({ friction, friction_bound }) => !(friction > 0) && !(friction_bound > 0)))
    available -= 0.5 * mass * Math.min(squared(impact.tangential_velocity_before), squared(impact.tangential_velocity_after));
  return 0.5 * mass * toNumber(impact.normal_velocity_after) ** 2 > (1 + tolerance) * available;
}

/** In words, each. */
function reasons(run: Run): string[] {
  const { energy_gain: gain, energy_scale: scale } = run.data.judgement;
  const result: string[] = [];
  if (gain > tolerance * scale) result.push(`${run.summary.scheme} creates energy`);
  if (turnsInImpacts(run.data.judgement)) result.push("small strain does not hold");
  return result;
}

/** Of the energy that there was: a run that creates more has made the velocities after its impacts up. */
const muchEnergy = 0.1;

/** Where the method has changed the energy by much of what the body lost. */
function inexact(run: Run, impact: Impact): RestitutionRemark | null {
  if (!impact.restitution_inexact) return null;
  const approach = 0.5 * approachMass(run, impact) * toNumber(impact.normal_velocity_before) ** 2;
  const method = toNumber(impact.method_energy ?? null) / approach;
  const body = 1 - toNumber(impact.restitution) ** 2;
  const share = (part: number) => `${number(100 * Math.abs(part), 2)} %`;
  return { grade: "fair", words: `inexact: the method ${method < 0 ? "lost" : "created"} ${share(method)}, the body lost ${share(body)}`,
    detail: "of the energy of the approach; a smaller time step, and smaller cells, leave less to the method" };
}

/** Null where there is nothing to remark. */
export function restitutionRemark(run: Run, impact: Impact): RestitutionRemark | null {
  const { energy_gain: gain, energy_scale: scale } = run.data.judgement;
  if (!(toNumber(impact.restitution) > 1 + tolerance)) {
    if (!Number.isFinite(toNumber(impact.restitution))) return null;
    if (!(gain > muchEnergy * scale)) return inexact(run, impact);
    return { grade: "poor", words: `not to be trusted: ${reasons(run).join("; ")}`, detail: "the run creates more than a tenth of the energy that there was: any ratio may come out" };
  }
  if (["load_work", "support_work", "obstacle_work"].some((work) => acts(run, work)))
    return { grade: "fair", words: "above 1: driven", detail: "loads, supports or a moving obstacle do work on the body" };
  const known = reasons(run);
  if (exceedsEnergy(run, impact))
    return { grade: "poor", words: `impossible: ${known.length > 0 ? known.join("; ") : "the results do not tell why"}`, detail: "nothing drives the body, and it leaves with more energy than it had" };
  return { grade: "fair", words: `above 1: ${[`fed by ${acts(run, "load_potential") ? "loads, " : ""}sliding, spin or vibration`, ...known].join(", or ")}`, detail: "nothing drives the body, but the energy for it was there: in other motion, as strain, or in the potential of loads such as gravity" };
}
