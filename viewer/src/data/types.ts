/** The data of a report, written by src/ricochet/report/page.cpp. */

import type { Real, Summary } from "./summary";

export type { Expectation, Impact, OtherBody, PeakStress, Real, Summary } from "./summary";

/** A number of a summary, or null if it is unknown or does not exist. */
export type Value = Real | null;

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
  /** Parts that were not checked, in words; empty if none. */
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
  format: 6;
  version: string;
  runs: RunData[];
}

/** The entries of a judgement that are text. */
export const judgementTexts = new Set(["force", "node_force", "penetration_not_watched", "unwatched_penetration", "contact_beyond_rim"]);
