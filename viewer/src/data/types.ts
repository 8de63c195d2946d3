/** The data of a report as src/ricochet/report/page.cpp writes them. */

export interface PackedArray {
  blob: number;
  rows: number;
  columns: number;
  coding: "reals" | "indices" | "levels";
  /** Of levels: value = low + level · step; the largest level of so many bits stands for "no number". */
  bits?: number;
  prediction?: 1 | 2;
  low?: number;
  step?: number;
}

export interface Judgement {
  /** When a number is not finite for the first time: the others say nothing then. */
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
  /** Of the first probe on the contact boundary; "": there is none. */
  node_force: string;
  node_roughness: number;
  penetration: number;
  /** null: the body's size is not known. */
  relative_penetration: number | null;
  /** Whether the boundary outside of contact groups, and bodies against each other, were looked at. */
  penetration_checked: boolean;
  /** What else was not looked at, in words; empty: nothing. */
  penetration_not_watched: string;
  /** Where no contact prevents it: which body in which obstacle or in itself, or which bodies; empty: nowhere. */
  unwatched_penetration: string;
  /** The group of a contact that goes on beyond it; empty: none. */
  contact_beyond_rim: string;
  /** The largest of a cell, in rad. */
  rotation: number;
  /** In rad: above it small strain no longer holds. */
  /** Above it small strain does not hold; null: the laws hold for any rotation. */
  rotation_limit: number | null;
  /** Whether cells turn too far for small strain only after the last impact. */
  rotation_after_impacts: boolean;
}

export interface ContactData {
  times: number[];
  /** Numbers of the contact nodes in the body's surface; −1 where it does not show the node. */
  nodes: PackedArray;
  /** In the plane: arc length, and where each piece of the boundary begins. */
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
  /** The inside of a solid, where there was room for it. */
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
  /** Of each cell, from 0. */
  obstacle: PackedArray;
  times: number[];
  /** One row where obstacles stand or only translate, else one for each time. */
  positions: PackedArray;
  /** From the one row of positions, three numbers for each obstacle; null: nothing moves, or something turns. */
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

/** A number that is not finite is a word in JSON: "inf", "-inf", "nan"; what is not known is null. */
export type Value = number | string | null;

/** A body's collision with an obstacle; see docs/results.md. */
/** The other body of an impact of two. */
export interface OtherBody {
  body: number;
  velocity_before: Value[];
  velocity_after: Value[] | null;
  spin_before: Value | Value[];
  spin_after: Value | Value[];
  kinetic_energy_before: Value;
}

export interface Impact {
  body: number;
  /** null where two bodies met. */
  obstacle: string | null;
  against?: OtherBody;
  begin: number;
  end: number | null;
  duration: number;
  ended: boolean;
  from_start: boolean;
  restitution: Value;
  /** A sentence, where the restitution is null. */
  why_no_restitution?: string | null;
  /** What the method put into the bodies meanwhile, and whether that spoils the restitution; not in older results. */
  method_energy?: Value;
  restitution_inexact?: boolean;
  /** That carried a force at once, at most, and how many there are; not in results of older versions. */
  contact_points?: number;
  all_contact_points?: number;
  /** So few of them that the largest force and the duration cannot be trusted. */
  coarse?: boolean;
  /** Of all contact forces; friction included. */
  impulse: Value[];
  normal_impulse: Value;
  largest_force: Value;
  largest_force_time: number;
  normal_velocity_before: Value;
  normal_velocity_after: Value;
  tangential_velocity_before: Value[] | null;
  tangential_velocity_after: Value[] | null;
  /** In the plane one number, about z. */
  spin_before: Value | Value[];
  spin_after: Value | Value[];
  kinetic_energy_before: Value;
  kinetic_energy_ratio: Value;
}

/** The largest von Mises stress of a run, between frames, too. */
export interface PeakStress {
  von_mises: Value;
  time: number;
  step: number;
  /** Centre of the cell at the start. */
  place: number[];
  material: string;
  cell: number;
  states_looked_at: number;
  states: number;
  /** What makes it grow with refinement, as "a re-entrant edge of the body"; null or absent: nothing that is known. */
  sits_on?: string | null;
}

/** Of the largest energy; what the method itself did, apart from what acts on the body. */
export interface EnergyBudget {
  largest_energy: Value;
  lost_by_method: Value;
  created_by_method: Value;
  at_end: Record<string, Value>;
}

/** Which reactions acted over the steps. */
export interface Reactions {
  acting: "end" | "mean" | "adaptive";
  /** null: no mean acted. */
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
  /** Null where all steps are of one length. */
  adaptive_steps?: { shortest: number; longest: number; refused: number } | null;
  end_time: number;
  steps: number;
  steps_asked_for: number;
  frames: number;
  instants: { energy: string; force: string };
  timings_seconds: Record<string, number>;
  seconds_per_step: number;
  /** Not in results of older versions; of schemes without a choice the reactions are null. */
  energy_budget?: EnergyBudget | null;
  reactions?: Reactions | null;
  contacts: { group: string; obstacle?: string; against?: string; multipliers: string; friction: number; friction_bound: number }[];
  probes: { name: string; position: number[]; distance: number; in_contact_boundary: boolean }[];
  checks: Record<string, CheckOutcome>;
  warnings: string[];
  /** `held`: supports at rest hold it; not in results of older versions. */
  bodies: { mass: Value; name?: string; held?: boolean }[];
  impacts: Impact[];
  impacts_left_out: number;
  /** Contacts between bodies that slide far, where held steps have left points at a gap; not in results of older versions. */
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
  /** Probes that write rows of their own, each so many steps. */
  tables: { file: string; columns: string[]; values: PackedArray }[];
  /** 0: all rows; else of how many rows each pair stands for the least and the largest value. */
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

/** Of a judgement, what is text and no number. */
export const judgementTexts = new Set(["force", "node_force", "penetration_not_watched", "unwatched_penetration", "contact_beyond_rim"]);
