/** The data of a report, written by src/ricochet/report/page.cpp. */

export interface PackedArray {
  blob: number;
  rows: number;
  columns: number;
  coding: "reals" | "indices" | "levels";
  /** For levels: value = low + level · step; the largest level of `bits` bits means "no number". */
  bits?: number;
  prediction?: 1 | 2;
  low?: number;
  step?: number;
}

export interface Judgement {
  /** Time of the first number that is not finite, or null; the related numbers are then meaningless. */
  energy_broken_at: number | null;
  force_broken_at: number | null;
  penetration_broken_at: number | null;
  energy_scale: number;
  is_isolated: boolean;
  energy_gain: number;
  energy_loss: number;
  energy_change: number;
  energy_residual: number;
  force: string;
  force_largest: number;
  force_largest_at: number;
  force_variation: number;
  trend_variation: number;
  roughness: number;
  /** Column of the first probe on the contact boundary; "" if there is none. */
  node_force: string;
  node_roughness: number;
  penetration: number;
  /** null if the size of the body is unknown. */
  relative_penetration: number | null;
  /** Whether the boundary outside of contact groups, and bodies against each other, were checked. */
  penetration_checked: boolean;
  /** Other parts that were not checked, in words; empty if none. */
  penetration_not_watched: string;
  /** Penetration that no contact prevents: the body and the obstacle, or the bodies; empty if there is none. */
  unwatched_penetration: string;
  /** The group of a contact that extends beyond the group; empty if none. */
  contact_beyond_rim: string;
  /** Largest rotation of a cell, in rad. */
  rotation: number;
  /** Rotation in rad above which small strain does not hold; null if the laws hold for any rotation. */
  rotation_limit: number | null;
  /** Whether cells exceed this limit only after the last impact. */
  rotation_after_impacts: boolean;
}

export interface ContactData {
  times: number[];
  /** Numbers of the contact nodes in the body's surface; −1 if the surface does not contain the node. */
  nodes: PackedArray;
  /** In the plane: arc length of each node, and first node of each piece of the boundary. */
  position?: PackedArray;
  pieces?: number[];
  quantities: { name: string; values: PackedArray }[];
}

export interface BodyData {
  nodes: number;
  triangles: number;
  times: number[];
  positions: PackedArray;
  corners: PackedArray;
  triangle_cells: PackedArray;
  edges: PackedArray;
  mean: PackedArray;
  deviations: PackedArray[];
  fields: { name: string; on_nodes: boolean; values: PackedArray }[];
  /** The inside of a solid, if there was room for it. */
  volume: VolumeData | null;
}

export interface VolumeData {
  nodes: number;
  tetrahedra: number;
  positions: PackedArray;
  corners: PackedArray;
  cells: PackedArray;
  faces: PackedArray;
  deviations: PackedArray[];
  fields: { name: string; on_nodes: boolean; values: PackedArray }[];
}

export interface ObstacleData {
  corners: number;
  cells: PackedArray;
  /** Number of the obstacle of each cell, from 0. */
  obstacle: PackedArray;
  times: number[];
  /** One row if obstacles are at rest or only translate, otherwise one for each time. */
  positions: PackedArray;
  /** Offsets from the one row of positions, three numbers for each obstacle; null if no obstacle moves, or one rotates. */
  offsets: PackedArray | null;
}

export interface CheckOutcome {
  limit: number;
  largest: number;
}

export interface Expectation {
  quantity: string;
  value: number;
  wanted: string;
  checked: boolean;
  holds: boolean;
  note: string;
}

/** A number that is not finite is a word in JSON, "inf", "-inf" or "nan"; an unknown one is null. */
export type Value = number | string | null;

/** The other body of an impact between two bodies. */
export interface OtherBody {
  body: number;
  velocity_before: Value[];
  velocity_after: Value[] | null;
  spin_before: Value | Value[];
  spin_after: Value | Value[];
  kinetic_energy_before: Value;
}

/** A collision of a body with an obstacle or another body; see docs/impacts.md. */
export interface Impact {
  body: number;
  /** null if two bodies met. */
  obstacle: string | null;
  against?: OtherBody;
  begin: number;
  end: number | null;
  duration: number;
  ended: boolean;
  from_start: boolean;
  restitution: Value;
  /** A sentence, if the restitution is null. */
  why_no_restitution?: string | null;
  /** Energy that the method added to the bodies during the impact, and whether it makes the restitution inexact; not in older results. */
  method_energy?: Value;
  restitution_inexact?: boolean;
  /** Largest number of contact points that carried a force at once, and number of all; not in results of older versions. */
  contact_points?: number;
  all_contact_points?: number;
  /** Whether these are too few for a reliable largest force and duration. */
  coarse?: boolean;
  /** Impulse of all contact forces, including friction. */
  impulse: Value[];
  normal_impulse: Value;
  largest_force: Value;
  largest_force_time: number;
  normal_velocity_before: Value;
  normal_velocity_after: Value;
  tangential_velocity_before: Value[] | null;
  tangential_velocity_after: Value[] | null;
  /** One number in the plane, about z. */
  spin_before: Value | Value[];
  spin_after: Value | Value[];
  kinetic_energy_before: Value;
  kinetic_energy_ratio: Value;
}

/** The largest von Mises stress of a run, also between frames. */
export interface PeakStress {
  von_mises: Value;
  time: number;
  step: number;
  /** Initial centre of the cell. */
  place: number[];
  material: string;
  cell: number;
  states_looked_at: number;
  states: number;
  /** The reason why it grows with refinement, such as "a re-entrant edge of the body"; null or absent if none is known. */
  sits_on?: string | null;
}

/** Changes of the energy by the method itself, as fractions of the largest energy. */
export interface EnergyBudget {
  largest_energy: Value;
  lost_by_method: Value;
  created_by_method: Value;
  at_end: Record<string, Value>;
}

/** Which reactions acted over the steps. */
export interface Reactions {
  acting: "end" | "mean" | "adaptive";
  /** null if no mean acted. */
  least_end_weight: Value;
  largest_end_weight: Value;
  steps_of_means: number;
  steps_without_mean: number;
}

/** summary.json of a run; see docs/results.md. */
export interface Summary {
  status: string;
  message: string;
  title: string;
  case: string;
  ricochet_version: string;
  libraries: string;
  scheme: string;
  mass: string;
  dimension: number;
  degree: number;
  nodes: number;
  cells: number;
  dofs: number;
  contact_points: number;
  supported_dofs: number;
  solver: string;
  factor_entries: number;
  time_step: number;
  /** null if all steps have one length. */
  adaptive_steps?: { shortest: number; longest: number; refused: number } | null;
  end_time: number;
  steps: number;
  steps_asked_for: number;
  frames: number;
  instants: { energy: string; force: string };
  timings_seconds: Record<string, number>;
  seconds_per_step: number;
  /** Not in results of older versions; the reactions of schemes without a choice are null. */
  energy_budget?: EnergyBudget | null;
  reactions?: Reactions | null;
  contacts: { group: string; obstacle?: string; against?: string; multipliers: string; friction: number; friction_bound: number }[];
  probes: { name: string; position: number[]; distance: number; in_contact_boundary: boolean }[];
  checks: Record<string, CheckOutcome>;
  warnings: string[];
  /** `held`: held by supports at rest; not in results of older versions. */
  bodies: { mass: Value; name?: string; held?: boolean }[];
  impacts: Impact[];
  impacts_left_out: number;
  /** Contacts with large sliding in which frozen steps have left gaps; not in results of older versions. */
  unsettled_contacts?: { contact: number; share_of_force: Value; steps: number; first_time: Value; time: Value; gap: Value }[];
  peak_stress: PeakStress | null;
  expectations: Expectation[];
  parameters: Record<string, string>;
}

export interface RunData {
  name: string;
  directory: string;
  thinned: string[];
  summary: Summary;
  judgement: Judgement;
  columns: string[];
  history: PackedArray;
  /** Histories of probes that write rows of their own. */
  tables: { file: string; columns: string[]; values: PackedArray }[];
  /** 0 if all rows are stored; otherwise the number of rows whose least and largest value each pair of rows has. */
  rows_per_pair: number;
  obstacles: ObstacleData | null;
  body: BodyData | null;
  contact: ContactData | null;
}

export interface PageData {
  format: 5;
  version: string;
  runs: RunData[];
}

/** The entries of a judgement that are text. */
export const judgementTexts = new Set(["force", "node_force", "penetration_not_watched", "unwatched_penetration", "contact_beyond_rim"]);
