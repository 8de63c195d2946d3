import { valueAt, type Levels } from "../data/decode";
import type { Body } from "../data/run";

/** Positions of the nodes of a body, its boxes, outline and normals. */

/** Nodes that move: those of a body's surface, or of its inside. */
export interface Moving {
  nodes: number;
  positions: Levels;
  deviations: Levels[];
}

/** Reference positions, three numbers for each node. */
export function referencePositions({ nodes, positions }: Moving): Float32Array {
  const result = new Float32Array(3 * nodes);
  for (let k = 0; k < positions.rows; ++k)
    for (let i = 0; i < nodes; ++i) result[3 * i + k] = valueAt(positions, k, i);
  return result;
}

/** Computes X + ū + scale · (u − ū); the mean displacement ū is never scaled, so that the body keeps its position. */
export function placeNodes({ deviations }: Moving, means: Float64Array, reference: Float32Array, frame: number, scale: number, out: Float32Array): void {
  out.set(reference);
  deviations.forEach(({ levels, columns, low, step, none }, k) => {
    const mean = means[3 * frame + k];
    for (let i = 0; i < columns; ++i) {
      const level = levels[frame * columns + i];
      if (level !== none) out[3 * i + k] += mean + scale * (low + step * level);
    }
  });
}

export interface Box {
  low: [number, number, number];
  high: [number, number, number];
}

export function boxOf(positions: Float32Array, box: Box = emptyBox()): Box {
  for (let i = 0; i < positions.length; ++i) {
    const k = i % 3;
    if (positions[i] < box.low[k]) box.low[k] = positions[i];
    if (positions[i] > box.high[k]) box.high[k] = positions[i];
  }
  return box;
}

export const emptyBox = (): Box => ({ low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] });
export const diagonal = (box: Box) => Math.hypot(...box.high.map((value, k) => value - box.low[k]));
export const join = (a: Box, b: Box): Box => ({
  low: a.low.map((value, k) => Math.min(value, b.low[k])) as Box["low"],
  high: a.high.map((value, k) => Math.max(value, b.high[k])) as Box["high"],
});

/** The box around the body in all frames, sampled at some forty of them. */
export function boxOverTime(body: Body, reference: Float32Array): Box {
  const positions = new Float32Array(reference.length);
  const box = emptyBox();
  const step = Math.max(1, Math.floor(body.times.length / 40));
  for (let frame = 0; frame < body.times.length; frame += step) {
    placeNodes(body, body.mean, reference, frame, 1, positions);
    boxOf(positions, box);
  }
  return box;
}

/** The outline of a plane body: the sides that belong to one triangle only. */
export function outlineOf(body: Body): Int32Array {
  const seen = new Map<number, number>();
  const key = (a: number, b: number) => (a < b ? a * body.nodes + b : b * body.nodes + a);
  for (let t = 0; t < body.triangles; ++t) {
    for (let k = 0; k < 3; ++k) {
      const side = key(body.corners[3 * t + k], body.corners[3 * t + ((k + 1) % 3)]);
      seen.set(side, (seen.get(side) ?? 0) + 1);
    }
  }
  const result: number[] = [];
  for (const [side, times] of seen) if (times === 1) result.push(Math.floor(side / body.nodes), side % body.nodes);
  return Int32Array.from(result);
}

/** Outward unit normals at the nodes of a body, from the adjacent sides (in space triangles) of its surface. */
export class OutwardNormals {
  readonly values: Float32Array;
  /** In the plane: the node opposite to each side of the outline, on its inner side. */
  private readonly opposite: Int32Array;

  constructor(
    private readonly body: Body,
    private readonly outline: Int32Array,
  ) {
    this.values = new Float32Array(3 * body.nodes);
    const third = new Map<number, number>();
    const key = (a: number, b: number) => (a < b ? a * body.nodes + b : b * body.nodes + a);
    for (let i = 0; i < outline.length; i += 2) third.set(key(outline[i], outline[i + 1]), -1);
    for (let t = 0; t < body.triangles && outline.length > 0; ++t) {
      for (let k = 0; k < 3; ++k) {
        const side = key(body.corners[3 * t + k], body.corners[3 * t + ((k + 1) % 3)]);
        if (third.has(side)) third.set(side, body.corners[3 * t + ((k + 2) % 3)]);
      }
    }
    this.opposite = Int32Array.from({ length: outline.length / 2 }, (_, i) => third.get(key(outline[2 * i], outline[2 * i + 1]))!);
  }

  update(positions: Float32Array): void {
    this.values.fill(0);
    if (this.body.dimension === 2) this.addSides(positions);
    else this.addTriangles(positions);
    for (let i = 0; i < this.values.length; i += 3) {
      const length = Math.hypot(this.values[i], this.values[i + 1], this.values[i + 2]) || 1;
      for (let k = 0; k < 3; ++k) this.values[i + k] /= length;
    }
  }

  private addSides(at: Float32Array): void {
    this.opposite.forEach((inside, i) => {
      const a = 3 * this.outline[2 * i];
      const b = 3 * this.outline[2 * i + 1];
      const c = 3 * inside;
      let x = at[b + 1] - at[a + 1];
      let y = at[a] - at[b];
      if (x * (at[c] - at[a]) + y * (at[c + 1] - at[a + 1]) > 0) [x, y] = [-x, -y];
      for (const node of [a, b]) {
        this.values[node] += x;
        this.values[node + 1] += y;
      }
    });
  }

  private addTriangles(at: Float32Array): void {
    const box = boxOf(at);
    const centre = box.low.map((value, k) => (value + box.high[k]) / 2);
    const { corners, triangles } = this.body;
    for (let t = 0; t < triangles; ++t) {
      const [a, b, c] = [3 * corners[3 * t], 3 * corners[3 * t + 1], 3 * corners[3 * t + 2]];
      const [ux, uy, uz] = [at[b] - at[a], at[b + 1] - at[a + 1], at[b + 2] - at[a + 2]];
      const [vx, vy, vz] = [at[c] - at[a], at[c + 1] - at[a + 1], at[c + 2] - at[a + 2]];
      let [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
      if (x * (at[a] - centre[0]) + y * (at[a + 1] - centre[1]) + z * (at[a + 2] - centre[2]) < 0) [x, y, z] = [-x, -y, -z];
      for (const node of [a, b, c]) {
        this.values[node] += x;
        this.values[node + 1] += y;
        this.values[node + 2] += z;
      }
    }
  }
}

/** Number of the body of each triangle, in the order of the bodies' first triangles; null if there is one body. */
export function bodiesOf(body: Body): Float32Array | null {
  const root = Int32Array.from({ length: body.corners.reduce((most, node) => Math.max(most, node), -1) + 1 }, (_, node) => node);
  const find = (node: number): number => {
    while (root[node] !== node) node = root[node] = root[root[node]];
    return node;
  };
  for (let t = 0; t < body.triangles; ++t) {
    const first = find(body.corners[3 * t]);
    for (const k of [1, 2]) root[find(body.corners[3 * t + k])] = first;
  }
  const numbers = new Map<number, number>();
  const result = Float32Array.from({ length: body.triangles }, (_, t) => {
    const own = find(body.corners[3 * t]);
    if (!numbers.has(own)) numbers.set(own, numbers.size);
    return numbers.get(own)!;
  });
  return numbers.size > 1 ? result : null;
}
