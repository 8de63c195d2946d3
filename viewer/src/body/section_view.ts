import * as three from "three";
import type { Body, Volume } from "../data/run";
import type { Store } from "../store";
import { ownFieldAt, type FieldValues } from "./fields";
import { placeNodes, referencePositions, type Box } from "./geometry";
import { bodyMaterial } from "./material";
import { sectionOf, type Section } from "./section";

/** The store's plane in a body with this initial box; the part above `at` along `sign` is removed. */
export interface Cut {
  axis: number;
  at: number;
  sign: 1 | -1;
}

export function cutOf(store: Store, box: Box): Cut | null {
  if (store.cut === "") return null;
  const axis = ["x", "y", "z"].indexOf(store.cut);
  // The part in front of the plane, seen from the front, is removed.
  const sign = (axis === 1) !== store.cutFlipped ? -1 : 1;
  const part = Math.min(Math.max(store.cutAt, 1e-3), 1 - 1e-3);
  return { axis, at: box.low[axis] + part * (box.high[axis] - box.low[axis]), sign };
}

/** The section of a solid by a plane. */
export class SectionView {
  readonly mesh: three.Mesh<three.BufferGeometry, three.ShaderMaterial>;
  section: Section | null = null;
  values: FieldValues | null = null;
  readonly reference: Float32Array;
  readonly positions: Float32Array;
  private key = "";

  constructor(private readonly body: Body, private readonly volume: Volume, content: three.Object3D) {
    this.reference = referencePositions(volume);
    this.positions = new Float32Array(this.reference.length);
    this.mesh = new three.Mesh(new three.BufferGeometry(), bodyMaterial(true));
    this.mesh.frustumCulled = false;
    content.add(this.mesh);
  }

  update(cut: Cut | null, store: Store, frame: number): void {
    this.mesh.visible = cut !== null;
    if (!cut) return;
    this.choose(cut);
    placeNodes(this.volume, this.body.mean, this.reference, frame, store.deformation, this.positions);
    this.values = store.field === "" ? null : ownFieldAt(this.volume, this.body.mean, store.field, frame, this.values?.values);
    this.fill();
  }

  private choose({ axis, at }: Cut): void {
    const key = `${axis} ${at}`;
    if (key === this.key) return;
    this.key = key;
    const section = (this.section = sectionOf(this.volume, this.reference, axis, at));
    const corners = 3 * section.triangles;
    this.mesh.geometry.dispose();
    const geometry = (this.mesh.geometry = new three.BufferGeometry());
    for (const name of ["position", "values"])
      geometry.setAttribute(name, new three.BufferAttribute(new Float32Array(3 * corners), 3).setUsage(three.DynamicDrawUsage));
    geometry.setAttribute("origin", new three.BufferAttribute(new Float32Array(3 * corners), 3));
    geometry.setAttribute("edges", new three.BufferAttribute(Float32Array.from({ length: corners }, (_, i) => section.edges[Math.floor(i / 3)]), 1));
  }

  private fill(): void {
    const { from, to, part, tetrahedra } = this.section!;
    const { positions } = this;
    const places = this.mesh.geometry.attributes.position as three.BufferAttribute;
    const values = this.mesh.geometry.attributes.values as three.BufferAttribute;
    const own = new Float32Array(3);
    for (let i = 0; i < from.length; ++i) {
      const [a, b, s] = [3 * from[i], 3 * to[i], part[i]];
      for (let k = 0; k < 3; ++k) places.array[3 * i + k] = positions[a + k] + s * (positions[b + k] - positions[a + k]);
      if (!this.values) continue;
      const { onNodes, values: field } = this.values;
      own[i % 3] = onNodes ? field[from[i]] + s * (field[to[i]] - field[from[i]]) : field[this.volume.cells[tetrahedra[Math.floor(i / 3)]]];
      if (i % 3 === 2) for (let corner = i - 2; corner <= i; ++corner) values.array.set(own, 3 * corner);
    }
    places.needsUpdate = true;
    values.needsUpdate = true;
  }

  /** Value of the field in one of the section's triangles, at these barycentric coordinates. */
  valueAt(triangle: number, weights: number[]): number {
    const values = this.mesh.geometry.attributes.values.array;
    return this.values ? weights.reduce((sum, weight, k) => sum + weight * values[9 * triangle + k], 0) : NaN;
  }
}
