import { extentOf } from "../charts/scale";
import type { Run } from "../data/run";
import type { Impact, Value } from "../data/types";
import { columnName, toNumber } from "../format";
import { spin } from "./outcomes";

/** A result of a run, one number. */
export interface Quantity {
  id: string;
  title: string;
  value: (run: Run) => number;
}

const last = (values: Float64Array) => values[values.length - 1] ?? NaN;
const largest = (values: Float64Array) => {
  const { low, high } = extentOf("", values);
  return Math.max(Math.abs(low), Math.abs(high));
};
const ratio = (values: Float64Array) => (values.length > 0 && values[0] !== 0 ? last(values) / values[0] : NaN);

/** Time with contact; NaN if the page does not have all rows. */
function timeInContact(run: Run): number {
  if (run.data.rows_per_pair > 0) return NaN;
  const times = run.column("time");
  const active = run.column("active_contacts");
  let sum = 0;
  for (let i = 1; i < times.length; ++i) if (active[i] > 0) sum += times[i] - times[i - 1];
  return sum;
}

/** The results that at least one run has, the most significant ones first. */
export function quantities(runs: Run[]): Quantity[] {
  const first = (of: (impact: Impact) => Value | Value[]) => (run: Run) => (run.summary.impacts.length > 0 ? spin(of(run.summary.impacts[0])) : NaN);
  const list: Quantity[] = [
    { id: "restitution", title: "restitution of the first impact", value: first(({ restitution }) => restitution) },
    { id: "duration", title: "duration of the first impact", value: first(({ duration, ended }) => (ended ? duration : null)) },
    { id: "impulse", title: "normal impulse of the first impact", value: first(({ normal_impulse, ended }) => (ended ? normal_impulse : null)) },
    { id: "impact-force", title: "largest force of the first impact", value: first(({ largest_force }) => largest_force) },
    { id: "spin", title: "spin after the first impact", value: first(({ spin_after }) => spin_after) },
    { id: "stress", title: "largest von Mises stress", value: (run) => toNumber(run.summary.peak_stress?.von_mises) },
    { id: "force", title: "largest contact force", value: (run) => run.data.judgement.force_largest },
    { id: "force-time", title: "time of the largest contact force", value: (run) => run.data.judgement.force_largest_at },
    { id: "contact-time", title: "time in contact", value: timeInContact },
    { id: "energy", title: "total energy, end / start", value: (run) => ratio(run.column("total_energy")) },
    { id: "kinetic", title: "kinetic energy, end / start", value: (run) => ratio(run.column("kinetic_energy")) },
    { id: "energy-change", title: "change of the total energy", value: (run) => last(run.column("total_energy")) - run.column("total_energy")[0] },
    { id: "method-loss", title: "energy lost by the method", value: (run) => toNumber(run.summary.energy_budget?.lost_by_method) },
    { id: "method-gain", title: "energy created by the method", value: (run) => toNumber(run.summary.energy_budget?.created_by_method) },
    { id: "friction-work", title: "friction work", value: (run) => last(run.column("friction_work")) },
    { id: "penetration", title: "deepest interpenetration", value: (run) => run.data.judgement.penetration },
    { id: "rotation", title: "largest rotation", value: (run) => largest(run.column("max_rotation")) },
    { id: "step-seconds", title: "computing time per step in seconds", value: (run) => run.summary.seconds_per_step },
  ];
  const columns = [...new Set(runs.flatMap((run) => [...run.history.keys()]))].filter((name) => name !== "step" && name !== "time");
  for (const column of columns) {
    list.push({ id: `largest ${column}`, title: `largest |${columnName(column)}|`, value: (run) => (run.has(column) ? largest(run.column(column)) : NaN) });
    list.push({ id: `last ${column}`, title: `${columnName(column)} at the end`, value: (run) => (run.has(column) ? last(run.column(column)) : NaN) });
  }
  return list.filter(({ value }) => runs.some((run) => Number.isFinite(value(run))));
}
