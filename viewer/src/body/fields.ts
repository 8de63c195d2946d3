import { valueAt, type Levels } from "../data/decode";
import { indexAt, type Field, type Run } from "../data/run";
import { toNumber } from "../format";
import type { Moving } from "./geometry";
import { colourRange, type ColourRange, type ColourScale } from "../maps/colour_range";

/** Fields for the colours of bodies. */

const axes = ["x", "y", "z"];
const contactOrder = ["contact_pressure", "contact_status", "friction_traction", "gap", "nominal_contact_pressure", "nominal_friction_traction"];

/** Names of the fields of all runs, first those of the body. */
export function fieldNames(runs: Run[]): string[] {
  const names = new Set<string>();
  for (const run of runs) {
    if (!run.body) continue;
    for (const field of run.body.fields) names.add(field.name);
    if (run.body.deviations.length > 0) names.add("displacement");
    for (let k = 0; k < run.body.deviations.length; ++k) names.add(`displacement_${axes[k]}`);
  }
  // In the plane the boundary is a line without colours; maps and bars show its fields.
  for (const name of contactOrder)
    if (runs.some((run) => run.summary.dimension === 3 && run.contact?.quantities.some((quantity) => quantity.name === name))) names.add(name);
  return [...names];
}

/** Values of a field at nodes or cells; NaN if there is none (off the contact boundary). */
export interface FieldValues {
  onNodes: boolean;
  values: Float32Array;
  /** Whether the values are integers with names, which must not be interpolated. */
  isStatus: boolean;
}

export function contactQuantity(run: Run, name: string): Levels | undefined {
  return run.contact?.quantities.find((quantity) => quantity.name === name)?.values;
}

/** A field of the body, on its surface or inside it. Reuses `out` if it has the right size. */
export function ownFieldAt(part: Moving & { fields: Field[] }, means: Float64Array, name: string, frame: number, out?: Float32Array): FieldValues | null {
  const room = (size: number) => (out?.length === size ? out : new Float32Array(size));
  if (name.startsWith("displacement")) {
    if (name !== "displacement" && axes.indexOf(name.slice(-1)) >= part.deviations.length) return null;
    const values = room(part.nodes);
    fillDisplacement(part, means, name === "displacement" ? -1 : axes.indexOf(name.slice(-1)), frame, values);
    return { onNodes: true, values, isStatus: false };
  }
  const own = part.fields.find((field) => field.name === name);
  if (!own) return null;
  const values = room(own.values.columns);
  const { levels, columns, low, step, none } = own.values;
  for (let i = 0; i < columns; ++i) {
    const level = levels[frame * columns + i];
    values[i] = level === none ? NaN : low + step * level;
  }
  return { onNodes: own.onNodes, values, isStatus: false };
}

export function fieldAt(run: Run, name: string, frame: number, out?: Float32Array): FieldValues | null {
  const body = run.body;
  if (!body || name === "") return null;
  const own = ownFieldAt(body, body.mean, name, frame, out);
  if (own) return own;
  const quantity = contactQuantity(run, name);
  const contact = run.contact;
  if (!quantity || !contact) return null;
  const values = out?.length === body.nodes ? out : new Float32Array(body.nodes);
  values.fill(NaN);
  const row = indexAt(contact.times, body.times[frame]);
  contact.nodes.forEach((node, i) => {
    if (node >= 0) values[node] = valueAt(quantity, row, i);
  });
  return { onNodes: true, values, isStatus: name === "contact_status" };
}

function fillDisplacement(part: Moving, means: Float64Array, axis: number, frame: number, values: Float32Array): void {
  const components = axis >= 0 ? [axis] : part.deviations.map((_, k) => k);
  for (let i = 0; i < part.nodes; ++i) {
    let sum = 0;
    for (const k of components) {
      const u = means[3 * frame + k] + valueAt(part.deviations[k], frame, i);
      if (axis >= 0) sum = u;
      else sum += u * u;
    }
    values[i] = axis >= 0 ? sum : Math.sqrt(sum);
  }
}

/** Range of the colours over all frames; null if the field has names instead of numbers or does not exist. */
export function fieldRange(run: Run, name: string, scale: ColourScale): ColourRange | null {
  const body = run.body;
  if (!body || name === "" || name === "contact_status") return null;
  const own = [body, body.volume].flatMap((part) => part?.fields.filter((field) => field.name === name).map(({ values }) => values) ?? []);
  const contact = contactQuantity(run, name);
  const peak = name === "von_mises" ? toNumber(run.summary.peak_stress?.von_mises) : NaN;
  if (own.length > 0) return colourRange(own, scale, Number.isFinite(peak) ? peak : 0);
  if (contact) return colourRange([contact], scale);
  let low = Infinity;
  let high = -Infinity;
  const step = Math.max(1, Math.floor(body.times.length / 40));
  for (let frame = 0; frame < body.times.length; frame += step) {
    const found = fieldAt(run, name, frame);
    if (!found) return null;
    for (const value of found.values) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (!(low < high)) return { low: Math.min(low, 0), high: low + 1, clipped: false, largest: low, logarithmic: false };
  return { low: name === "displacement" ? 0 : low, high, clipped: false, largest: high, logarithmic: false };
}
