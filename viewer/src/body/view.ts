import * as three from "three";
import { isDark, statusColour, themeColour } from "../colours";
import { valueAt } from "../data/decode";
import { indexAt, type Body, type Run } from "../data/run";
import type { Store } from "../store";
import { colourRange, joinRanges, type ColourRange } from "../maps/colour_range";
import { contactQuantity, fieldAt, fieldRange, type FieldValues } from "./fields";
import { bodiesOf, boxOf, boxOverTime, diagonal, outlineOf, OutwardNormals, placeNodes, referencePositions, type Box } from "./geometry";
import { bodyMaterial } from "./material";
import { ObstacleView } from "./obstacles";
import { MirrorImage } from "./mirror";
import { PeakMarker } from "./peak";
import { cutOf, SectionView, type Cut } from "./section_view";
import { ContactZone } from "./zone";

/** The body of one run with its obstacles and contact forces, drawn with three.js. */
export class BodyView {
  readonly scene = new three.Scene();
  /** All drawn objects, moved and scaled to fit the panel. */
  private readonly content = new three.Group();
  /** The boxes around the body in all frames, and at the start. */
  readonly box: Box;
  readonly start: Box;
  frame = -1;
  range: ColourRange | null = null;
  values: FieldValues | null = null;
  /** null if the run has no contact boundary. */
  readonly zone: ContactZone | null;
  /** null in the plane, and if the page had no room for it. */
  readonly section: SectionView | null;
  /** null if the summary has no largest stress. */
  readonly peak: PeakMarker | null;
  private cut: Cut | null = null;
  private readonly body: Body;
  /** Number of the body of each triangle; null if there is one body. */
  private readonly bodies: Float32Array | null;
  private readonly reference: Float32Array;
  private readonly positions: Float32Array;
  private readonly outlineSides: Int32Array;
  private readonly normals: OutwardNormals;
  private readonly mesh: three.Mesh<three.BufferGeometry, three.ShaderMaterial>;
  private readonly outline: three.LineSegments<three.BufferGeometry, three.LineBasicMaterial>;
  private readonly bars: three.Mesh<three.BufferGeometry, three.MeshBasicMaterial>;
  private readonly obstacles: ObstacleView | null;
  /** null if the run is not axisymmetric. */
  private readonly image: MirrorImage | null;
  private readonly size: number;
  private drawnField = "";
  private rangeKey = "";
  private values_: Float32Array | undefined;

  constructor(
    readonly run: Run,
    private readonly store: Store,
  ) {
    const body = (this.body = run.body!);
    this.bodies = bodiesOf(body);
    this.reference = referencePositions(body);
    this.positions = new Float32Array(this.reference.length);
    this.box = boxOverTime(body, this.reference);
    this.start = boxOf(this.reference);
    this.size = diagonal(this.start);
    const plane = body.dimension === 2;
    this.outlineSides = plane ? outlineOf(body) : new Int32Array(0);
    if (run.isAxisymmetric) this.outlineSides = offAxis(this.outlineSides, this.reference);
    this.normals = new OutwardNormals(body, contactSides(this.outlineSides, run));
    this.normals.update(this.reference);

    const geometry = new three.BufferGeometry();
    const corners = 3 * body.triangles;
    const dynamic = (size: number, items: number) =>
      new three.BufferAttribute(new Float32Array(size * items), items).setUsage(three.DynamicDrawUsage);
    geometry.setAttribute("position", dynamic(corners, 3));
    geometry.setAttribute("values", dynamic(corners, 3));
    const edges = Float32Array.from({ length: corners }, (_, i) => body.edges[Math.floor(i / 3)]);
    geometry.setAttribute("edges", new three.BufferAttribute(edges, 1));
    const origins = new Float32Array(3 * corners);
    expand(this.reference, body.corners, origins);
    geometry.setAttribute("origin", new three.BufferAttribute(origins, 3));
    this.mesh = new three.Mesh(geometry, bodyMaterial(!plane));
    const lines = new three.BufferGeometry();
    lines.setAttribute("position", dynamic(this.outlineSides.length, 3));
    this.outline = new three.LineSegments(lines, new three.LineBasicMaterial());
    const bars = new three.BufferGeometry();
    const count = run.contact ? run.contact.nodes.length : 0;
    bars.setAttribute("position", dynamic(6 * count, 3));
    bars.setAttribute("color", dynamic(6 * count, 3));
    this.bars = new three.Mesh(bars, new three.MeshBasicMaterial({ vertexColors: true, side: three.DoubleSide }));
    for (const object of [this.mesh, this.outline, this.bars]) {
      object.frustumCulled = false; // drawn objects move
      this.content.add(object);
    }
    this.scene.add(this.content);
    this.zone = run.contact ? new ContactZone(run, this.reference, this.size) : null;
    this.section = body.volume ? new SectionView(body, body.volume, this.content) : null;
    this.peak = run.summary.peak_stress ? new PeakMarker(run, this.section?.reference ?? this.reference) : null;
    if (this.peak) this.scene.add(this.peak.sprite);
    this.obstacles = run.obstacles ? new ObstacleView(run.obstacles, this.box, this.size, this.content) : null;
    this.image = run.isAxisymmetric ? new MirrorImage(this.content) : null;
    // The axis is at the centre of the picture.
    if (this.image) this.box.low[0] = Math.min(this.box.low[0], -this.box.high[0]);
  }

  /** Moves this point of space to the centre and scales this length to 1. */
  place(centre: three.Vector3, length: number): void {
    this.content.scale.setScalar(1 / length);
    this.content.position.copy(centre).multiplyScalar(-1 / length);
    this.content.updateMatrixWorld(true);
  }

  /** Updates everything that depends on the time and on the reader's choices. */
  update(): void {
    const { store, body } = this;
    this.frame = indexAt(body.times, store.time);
    placeNodes(body, body.mean, this.reference, this.frame, store.deformation, this.positions);
    const target = this.mesh.geometry.attributes.position as three.BufferAttribute;
    expand(this.positions, body.corners, target.array as Float32Array);
    target.needsUpdate = true;
    if (this.outlineSides.length > 0) {
      const sides = this.outline.geometry.attributes.position as three.BufferAttribute;
      expand(this.positions, this.outlineSides, sides.array as Float32Array);
      sides.needsUpdate = true;
    }
    this.cut = this.section ? cutOf(store, this.start) : null;
    this.section?.update(this.cut, store, this.frame);
    this.updateField();
    this.updateBars();
    this.obstacles?.update(store.time);
    this.updateColours();
    this.image?.update(store.whole);
  }

  private updateField(): void {
    const { store, body } = this;
    this.values = fieldAt(this.run, store.field, this.frame, this.values_);
    const { uniforms } = this.mesh.material;
    uniforms.cuts.value = this.cut !== null;
    if (this.cut) {
      const { axis, at, sign } = this.cut;
      (uniforms.cut.value as three.Vector4).fromArray([0, 0, 0, sign * at]).setComponent(axis, sign);
    }
    uniforms.kind.value = !this.values ? (this.bodies ? 3 : 0) : this.values.isStatus ? 2 : 1;
    if (this.section) this.section.mesh.material.uniforms.kind.value = this.section.values ? 1 : 0;
    if (!this.values) {
      if (this.bodies) this.setValues((t) => [this.bodies![t], this.bodies![t], this.bodies![t]]);
      return;
    }
    this.values_ = this.values.values;
    const { onNodes, values } = this.values;
    this.setValues((t) => {
      const cell = body.triangleCells[t];
      return [values[onNodes ? body.corners[3 * t] : cell], values[onNodes ? body.corners[3 * t + 1] : cell], values[onNodes ? body.corners[3 * t + 2] : cell]];
    });
    this.chooseRange();
    for (const { uniforms: own } of this.materials) {
      own.low.value = this.range?.low ?? 0;
      own.high.value = this.range?.high ?? 1;
      own.logarithmic.value = this.range?.logarithmic ?? false;
    }
  }

  /** Sets the values at the corners of each triangle. */
  private setValues(of: (triangle: number) => [number, number, number]): void {
    const target = this.mesh.geometry.attributes.values as three.BufferAttribute;
    const array = target.array as Float32Array;
    for (let t = 0; t < this.body.triangles; ++t) {
      const [a, b, c] = of(t);
      for (let at = 9 * t; at < 9 * t + 9; at += 3) {
        array[at] = a;
        array[at + 1] = b;
        array[at + 2] = c;
      }
    }
    target.needsUpdate = true;
  }

  private get materials(): three.ShaderMaterial[] {
    return [this.mesh.material, ...(this.section ? [this.section.mesh.material] : [])];
  }

  private chooseRange(): void {
    const { store } = this;
    const runs = store.sharedColours ? store.visibleRuns : [this.run];
    const key = `${store.field} ${store.scale} ${runs.map((run) => run.number).join()}`;
    if (key === this.rangeKey) return;
    this.rangeKey = key;
    this.range = joinRanges(runs.map((run) => fieldRange(run, store.field, store.scale)).filter((range) => range !== null));
  }

  /** Draws contact pressures as bars out of the body at the contact nodes, in the colour of the contact status. */
  private updateBars(): void {
    const contact = this.run.contact;
    const pressure = contactQuantity(this.run, "contact_pressure");
    this.bars.visible = this.store.showForces && pressure !== undefined;
    if (!contact || !pressure || !this.bars.visible) return;
    this.barScale ??= (0.22 * this.size) / Math.max(colourRange([pressure]).high, Number.MIN_VALUE);
    const status = contactQuantity(this.run, "contact_status");
    const row = indexAt(contact.times, this.body.times[this.frame]);
    const places = this.bars.geometry.attributes.position as three.BufferAttribute;
    const colours = this.bars.geometry.attributes.color as three.BufferAttribute;
    if (this.body.dimension === 2) this.normals.update(this.positions); // in space the initial normals suffice
    const half = Math.min(0.006 * this.size, (0.3 * this.size) / Math.max(contact.nodes.length, 1));
    const ofStatus = [-1, 0, 1, 2, 3].map((each) => new three.Color(statusColour(each)).toArray());
    contact.nodes.forEach((node, i) => {
      const value = Math.min(valueAt(pressure, row, i) * this.barScale!, 0.5 * this.size);
      const [red, green, blue] = ofStatus[status ? valueAt(status, row, i) + 1 : 2] ?? ofStatus[0];
      for (let corner = 0; corner < 6; ++corner) {
        const out = [0, 0, 1, 1, 0, 1][corner];
        const side = [-1, 1, 1, 1, -1, -1][corner];
        colours.setXYZ(6 * i + corner, red, green, blue);
        if (node < 0 || !(value > 1e-4 * this.size)) {
          places.setXYZ(6 * i + corner, 0, 0, 0);
          continue;
        }
        const [nx, ny, nz] = this.normals.values.subarray(3 * node, 3 * node + 3);
        // Direction across the bar: in the plane along the boundary, in space any perpendicular direction.
        const [tx, ty, tz] = this.body.dimension === 2 ? [-ny, nx, 0] : Math.abs(nz) > 0.7 ? [1, 0, 0] : [-ny, nx, 0];
        places.setXYZ(6 * i + corner,
          this.positions[3 * node] + out * value * nx + side * half * tx,
          this.positions[3 * node + 1] + out * value * ny + side * half * ty,
          this.positions[3 * node + 2] + out * value * nz + side * half * tz);
      }
    });
    places.needsUpdate = true;
    colours.needsUpdate = true;
  }
  private barScale: number | undefined;

  private updateColours(): void {
    const key = `${isDark()} ${this.store.field} ${this.store.showMesh}`;
    if (key === this.drawnField) return;
    this.drawnField = key;
    // The shader writes the colours of the screen, without conversion.
    const colour = (css: string) => new three.Color().setStyle(css, three.LinearSRGBColorSpace);
    for (const { uniforms } of this.materials) {
      uniforms.plain.value = colour(themeColour("body"));
      uniforms.line.value = colour(themeColour("text"));
      uniforms.lines.value = this.store.showMesh ? 0.55 : 0;
      uniforms.statuses.value = [-1, 0, 1, 2, 3].map((status) => colour(statusColour(status)));
    }
    this.outline.material.color.setStyle(themeColour("text"));
    this.obstacles?.recolour();
  }

  /** Shows the ring at the largest stress; called after the body was moved into the picture. */
  markPeak(camera: three.OrthographicCamera | three.PerspectiveCamera): void {
    if (!this.peak) return;
    const { times } = this.body;
    const ofStress = this.store.field === "von_mises" || this.store.field === "";
    this.peak.sprite.visible = ofStress;
    if (this.section) placeNodes(this.body.volume!, this.body.mean, this.section.reference, this.frame, this.store.deformation, this.section.positions);
    this.peak.update(this.section?.positions ?? this.positions, this.content, indexAt(times, this.run.summary.peak_stress!.time) !== this.frame);
    this.peak.scaleFor(camera);
  }

  /** Centres the contact zone and scales this length to 1; the view follows the zone from frame to frame. */
  placeOnZone(length: number): void {
    if (this.zone) this.place(new three.Vector3(...this.zone.centre(this.body.times[this.frame], this.positions)), length);
  }

  /** Normal out of the body at the contact zone. */
  zoneNormal(): three.Vector3 {
    this.normals.update(this.positions);
    return this.zone ? new three.Vector3(...this.zone.normal(this.store.time, this.normals)) : new three.Vector3(0, 0, -1);
  }

  showObstacles(opacity: number): void {
    this.obstacles?.fade(opacity);
  }

  /** Value of the field and position where a ray meets the body; null if it misses. */
  pick(ray: three.Raycaster): { value: number; place: three.Vector3 } | null {
    const image = this.image?.of(this.mesh);
    const meshes = [this.mesh, ...(this.section?.mesh.visible ? [this.section.mesh] : []), ...(image ? [image] : [])];
    for (const { geometry } of meshes) geometry.boundingSphere = geometry.boundingBox = null;
    for (const hit of ray.intersectObjects(meshes, false)) {
      const t = hit.faceIndex;
      if (t === null || t === undefined) continue;
      const place = this.content.worldToLocal(hit.point.clone());
      if (hit.object === image) {
        const own = this.picked(t, place.clone().setX(-place.x));
        return { value: own.value, place };
      }
      if (hit.object === this.section?.mesh) return { value: this.section.valueAt(t, weightsOf(hit, this.section.mesh)), place };
      if (!this.isCutOff(t, weightsOf(hit, this.mesh))) return this.picked(t, place);
    }
    return null;
  }

  private isCutOff(t: number, weights: number[]): boolean {
    if (!this.cut) return false;
    const { axis, at, sign } = this.cut;
    return sign * (weights.reduce((sum, weight, k) => sum + weight * this.reference[3 * this.body.corners[3 * t + k] + axis], 0) - at) > 0;
  }

  private picked(t: number, place: three.Vector3): { value: number; place: three.Vector3 } {
    if (!this.values) return { value: NaN, place };
    let value: number;
    if (!this.values.onNodes) {
      value = this.values.values[this.body.triangleCells[t]];
    } else {
      const nodes = [0, 1, 2].map((k) => this.body.corners[3 * t + k]);
      const distances = nodes.map((n) => place.distanceTo(new three.Vector3().fromArray(this.positions, 3 * n)));
      value = this.values.values[nodes[distances.indexOf(Math.min(...distances))]];
    }
    return { value, place };
  }
}

/** Barycentric coordinates of a hit in its triangle. */
function weightsOf(hit: three.Intersection, mesh: three.Mesh): number[] {
  const corner = (k: number) => new three.Vector3().fromBufferAttribute(mesh.geometry.attributes.position as three.BufferAttribute, 3 * hit.faceIndex! + k);
  const place = mesh.worldToLocal(hit.point.clone());
  return three.Triangle.getBarycoord(place, corner(0), corner(1), corner(2), new three.Vector3())?.toArray() ?? [1, 0, 0];
}

/** Removes sides on the axis x = 0, which are inside the body. */
function offAxis(outline: Int32Array, reference: Float32Array): Int32Array {
  const sides: number[] = [];
  for (let i = 0; i < outline.length; i += 2)
    if (reference[3 * outline[i]] !== 0 || reference[3 * outline[i + 1]] !== 0) sides.push(outline[i], outline[i + 1]);
  return Int32Array.from(sides);
}

/** The sides of an outline between nodes of the contact boundary, so that normals at its ends do not depend on other sides. */
function contactSides(outline: Int32Array, run: Run): Int32Array {
  const nodes = new Set(run.contact?.nodes);
  const sides: number[] = [];
  for (let i = 0; i < outline.length; i += 2)
    if (nodes.has(outline[i]) && nodes.has(outline[i + 1])) sides.push(outline[i], outline[i + 1]);
  return Int32Array.from(sides);
}

function expand(positions: Float32Array, corners: Int32Array, out: Float32Array): void {
  for (let i = 0, to = 0; i < corners.length; ++i) {
    const from = 3 * corners[i];
    out[to++] = positions[from];
    out[to++] = positions[from + 1];
    out[to++] = positions[from + 2];
  }
}
