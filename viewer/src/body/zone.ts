import { valueAt } from "../data/decode";
import { indexAt, type Run } from "../data/run";
import { contactQuantity } from "./fields";
import type { OutwardNormals } from "./geometry";

/** The contact zone of a body, shown by the views of it. */
export class ContactZone {
  /** Half the extent of the nodes in contact, the largest of all frames. */
  readonly radius: number;
  /** Nodes in contact in each frame of the contact boundary. */
  private readonly touching: number[][] = [];
  private readonly rows: number[];
  private readonly times: number[];

  /** `size`: of the body. */
  constructor(run: Run, reference: Float32Array, size: number) {
    const contact = run.contact!;
    const nodes = Array.from(contact.nodes);
    this.times = contact.times;
    const pressure = contactQuantity(run, "contact_pressure");
    const status = contactQuantity(run, "contact_status");
    const touches = (row: number, i: number) =>
      status ? valueAt(status, row, i) > 0 : pressure !== undefined && valueAt(pressure, row, i) > 2 * pressure.step;
    this.touching = this.times.map((_, row) => nodes.filter((node, i) => node >= 0 && touches(row, i)));
    this.rows = this.touching.flatMap((list, row) => (list.length > 0 ? [row] : []));
    const radius = Math.max(0, ...this.touching.map((list) => extent(list, reference) / 2));
    this.radius = Math.min(Math.max(radius, 0.03 * size), 0.5 * size);
    if (this.rows.length > 0) return;
    this.touching = [nodes.filter((node) => node >= 0)]; // without any contact: the whole contact boundary
    this.radius = Math.max(extent(this.touching[0], reference) / 2, 0.03 * size);
  }

  /** Nodes in contact at the nearest frame with contact. */
  nodesAt(time: number): number[] {
    if (this.rows.length === 0) return this.touching[0];
    return this.touching[this.rows[indexAt(this.rows.map((row) => this.times[row]), time)]];
  }

  centre(time: number, positions: Float32Array): [number, number, number] {
    return mean(this.nodesAt(time), positions);
  }

  /** Mean outward normal. */
  normal(time: number, normals: OutwardNormals): [number, number, number] {
    return mean(this.nodesAt(time), normals.values);
  }
}

function mean(nodes: number[], values: Float32Array): [number, number, number] {
  const sum: [number, number, number] = [0, 0, 0];
  for (const node of nodes) for (let k = 0; k < 3; ++k) sum[k] += values[3 * node + k] / nodes.length;
  return sum;
}

/** The diagonal of the box around nodes. */
function extent(nodes: number[], positions: Float32Array): number {
  const sides = [0, 1, 2].map((k) => {
    let [low, high] = [Infinity, -Infinity];
    for (const node of nodes) {
      low = Math.min(low, positions[3 * node + k]);
      high = Math.max(high, positions[3 * node + k]);
    }
    return nodes.length > 0 ? high - low : 0;
  });
  return Math.hypot(...sides);
}
