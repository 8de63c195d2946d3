import type { Run } from "../data/run";
import { extentOf } from "./scale";

/** A chart, with the columns of the history that it shows. */
export interface ChartDefinition {
  id: string;
  title: string;
  note: string;
  /** Columns that can be shown, in their order. */
  columns: string[];
  /** Columns shown at first. */
  shown: string[];
  /** Whether the vertical axis contains zero. */
  fromZero?: boolean;
  /** Whether curves of runs may coincide; lower ones are then drawn wider. */
  nested?: boolean;
  /** Whether the change since the start, relative to the initial value, can be chosen. */
  relative?: boolean;
}

const energies = ["total_energy", "kinetic_energy", "elastic_energy", "load_potential", "algorithmic_energy"];
const counts = ["active_contacts", "sticking", "slipping"];
const others = ["max_penetration", "max_rotation", "iterations"];

export function chartDefinitions(runs: Run[]): ChartDefinition[] {
  const all = [...new Set(runs.flatMap((run) => [...run.history.keys()]))];
  const present = (names: string[]) => names.filter((name) => all.includes(name));
  const matching = (pattern: RegExp) => all.filter((name) => pattern.test(name));
  const moves = (name: string) =>
    runs.some((run) => {
      const column = run.column(name);
      return column.some((value) => value !== column[0]);
    });
  const active = (names: string[]) => names.filter(moves);
  /** The column that changes most; the other components may be rounding. */
  const largest = (names: string[]) => {
    const change = (name: string) =>
      Math.min(...runs.filter((run) => run.has(name)).map((run) => {
        const { low, high } = extentOf(name, run.column(name));
        return high - low;
      }));
    return names.reduce<string | undefined>((best, name) => (best === undefined || change(name) > change(best) ? name : best), undefined);
  };
  const some = (names: string[], otherwise: string[]) => (names.length > 0 ? names : otherwise.slice(0, 1));

  const force = runs[0].data.judgement.force;
  const oneForce = runs.every((run) => run.data.judgement.force === force);
  const forces = [...(oneForce ? [] : ["@force"]), ...present([force, ...matching(/^contact_force_/), ...matching(/^pair_force\./), ...matching(/\.(reaction_|pressure$|force_)/)])];
  // The work of changes of the paired facets is a part of contact_work.
  const works = [...matching(/_work$/).filter((name) => name !== "re_pairing_work"), ...present(["viscous_dissipation"])];
  const momenta = matching(/^(angular_)?momentum[_.]/);
  const probes = all.filter((name) => name.includes(".") && !/^(pair_force|momentum)\./.test(name));
  const list: ChartDefinition[] = [
    {
      id: "energy",
      title: "Energy",
      note: runs.every((run) => run.data.judgement.is_isolated) ? "Nothing adds energy, so it must not rise." : "",
      columns: present(energies),
      shown: runs.length > 1 ? ["total_energy"] : some(active(energies.slice(0, 4)), energies),
      fromZero: true,
      nested: true,
      relative: true,
    },
    {
      id: "force",
      title: "Contact force",
      note: `${force.startsWith("pair_force.") ? "Between two bodies, on the body of the contact's group." : "On the body, of all contacts together."} Jumps from step to step come from the scheme, not from the body.`,
      columns: [...new Set(forces)],
      shown: [oneForce ? force : "@force"],
      fromZero: true,
    },
    {
      id: "works",
      title: "Energy account",
      note: "Work done on the body since the start. The residual is the error of the balance, at the size of rounding.",
      columns: [...works, ...present(["re_pairing_work", "numerical_dissipation", "integration_error", "velocity_correction", "energy_residual"])],
      shown: runs.length > 1 ? ["contact_work"] : some(active(works), ["contact_work"]),
    },
    {
      id: "residual",
      title: "Energy residual",
      note: "Error of the balance of all energies and works.",
      columns: present(["energy_residual"]),
      shown: ["energy_residual"],
    },
    { id: "momentum", title: "Momentum", note: "", columns: momenta, shown: [largest(momenta.filter((name) => name.startsWith("momentum"))) ?? momenta[0]] },
    {
      id: "counts",
      title: "Contact points",
      note: "Numbers of points that carry a force and, with friction, of those that stick and slip.",
      columns: present(counts),
      shown: some(active(counts), counts),
      fromZero: true,
    },
    {
      id: "others",
      title: "Interpenetration, rotation, iterations",
      note: "",
      columns: present(others),
      shown: ["max_penetration"],
      fromZero: true,
    },
  ];
  if (probes.length > 0) {
    const displacement = largest(probes.filter((name) => /displacement/.test(name)));
    list.push({
      id: "probes",
      title: "Probes",
      note: "",
      columns: probes,
      shown: [displacement ?? active(probes)[0] ?? probes[0]],
    });
  }
  return list.filter((definition) => definition.columns.length > 0);
}
