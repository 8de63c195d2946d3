import { indices, inflated, levels, reals, type Levels } from "./decode";
import { toNumber } from "../format";
import { judgementTexts, type BodyData, type Judgement, type PackedArray, type PageData, type RunData, type Summary, type VolumeData } from "./types";

/** Bytes of the page's blobs, each unpacked once. */
class Blobs {
  private readonly unpacked = new Map<number, Promise<Uint8Array>>();

  get(number: number): Promise<Uint8Array> {
    let bytes = this.unpacked.get(number);
    if (!bytes) {
      const element = document.getElementById(`ricochet-blob-${number}`);
      if (!element) throw new Error(`this file is truncated: block ${number} is missing`);
      bytes = inflated(element.textContent ?? "");
      this.unpacked.set(number, bytes);
    }
    return bytes;
  }
}

export interface Quantity {
  name: string;
  values: Levels;
}

/** The contact boundary over time. */
export interface Contact {
  times: number[];
  nodes: Int32Array;
  /** In the plane: arc length of each node, and first node of each piece; empty in space. */
  position: Float64Array;
  pieces: number[];
  quantities: Quantity[];
}

/** The body over time: X + ū(t) + (u(t) − ū(t)) with the mean displacement ū. */
export interface Body {
  dimension: number;
  nodes: number;
  triangles: number;
  times: number[];
  positions: Levels;
  corners: Int32Array;
  triangleCells: Int32Array;
  /** For each triangle: bit k is set if the side from its corner k is an edge of a cell. */
  edges: Uint8Array;
  mean: Float64Array;
  deviations: Levels[];
  fields: Field[];
  volume: Volume | null;
}

export type Field = Quantity & { onNodes: boolean };

/** The inside of a solid at the frames of its body. */
export interface Volume {
  nodes: number;
  positions: Levels;
  /** For each tetrahedron its four nodes, its cell, and in bit k whether the face opposite to corner k is a face of the cell. */
  corners: Int32Array;
  cells: Int32Array;
  faces: Uint8Array;
  deviations: Levels[];
  fields: Field[];
}

export interface Obstacles {
  corners: number;
  cells: Int32Array;
  /** Number of the obstacle of each cell, from 0. */
  obstacle: Int32Array;
  times: number[];
  positions: Float64Array;
  /** Three numbers for each obstacle and time if obstacles only translate; `positions` then has one row. */
  offsets: Float64Array | null;
}

export class Run {
  readonly name: string;
  readonly summary: Summary;
  history: Map<string, Float64Array> = new Map();
  /** Times of columns that are in a file with rows of its own instead of history.csv. */
  private readonly ownTimes = new Map<string, Float64Array>();
  contact: Contact | null = null;
  body: Body | null = null;
  obstacles: Obstacles | null = null;

  constructor(
    readonly number: number,
    readonly data: RunData,
    private readonly blobs: Blobs,
  ) {
    this.name = data.name;
    this.summary = data.summary;
  }

  /** The run's own name of a column: "@force" is the column by which its contact force is judged. */
  private own(name: string): string {
    return name === "@force" ? this.data.judgement.force : name;
  }

  /** Times at which the numbers of a column hold; energies and forces have their own instants. */
  timesOf(name: string): Float64Array {
    const column = this.own(name);
    const times = this.ownTimes.get(column) ?? this.column("time");
    const shift = this.shiftOf(column) * this.summary.time_step;
    return shift === 0 ? times : times.map((time) => time + shift);
  }

  /** Whether the body is the section of a body of revolution about the axis x = 0. */
  get isAxisymmetric(): boolean {
    return this.summary.parameters["mesh.plane"] === "axisymmetric";
  }

  column(name: string): Float64Array {
    return this.history.get(this.own(name)) ?? new Float64Array(0);
  }

  /** Magnitude of the judged contact force, of all obstacles together or between two bodies, in each row of the history. */
  get resultant(): Float64Array {
    const vector = this.own("@force").replace(/_[xyz]$/, "");
    this.resultant_ ??= lengths(["x", "y", "z"].map((axis) => this.history.get(`${vector}_${axis}`)).filter((column) => column !== undefined));
    return this.resultant_;
  }
  private resultant_: Float64Array | undefined;

  /** Magnitude at the row nearest to a time. */
  resultantAt(time: number): number {
    return this.resultant[indexAt(this.timesOf("@force"), time)] ?? NaN;
  }

  /** Time of the largest contact force, at the scheme's own instant. */
  get largestForceTime(): number {
    return this.data.judgement.force_largest_at + this.shiftOf(this.own("@force")) * this.summary.time_step;
  }

  has(name: string): boolean {
    return this.history.has(this.own(name));
  }

  private shiftOf(column: string): number {
    if (this.summary.adaptive_steps) return 0; // parts of steps of many lengths
    const energy = /^[^.]*_energy$|^load_potential$|^(angular_)?momentum_[^.]*$|^momentum\./.test(column);
    const force = /^contact_force_[^.]*$|^pair_force\.|\.(contact_force|reaction|(nominal_)?pressure)[^.]*$/.test(column);
    const instant = energy ? this.summary.instants.energy : force ? this.summary.instants.force : "";
    return Number(/t ([+-][\d.]+) time_step/.exec(instant)?.[1] ?? 0);
  }

  async loadHistory(): Promise<void> {
    const table = await this.reals(this.data.history);
    const rows = this.data.history.columns;
    this.data.columns.forEach((name, k) => this.history.set(name, table.subarray(k * rows, (k + 1) * rows)));
    for (const { columns, values } of this.data.tables) {
      const table = await this.reals(values);
      const own = columns.map((_, k) => table.subarray(k * values.columns, (k + 1) * values.columns));
      columns.forEach((name, k) => {
        if (this.history.has(name)) return; // step and time
        this.history.set(name, own[k]);
        this.ownTimes.set(name, own[columns.indexOf("time")]);
      });
    }
    if (this.data.obstacles) {
      const { corners, cells, obstacle, times, positions, offsets } = this.data.obstacles;
      this.obstacles = {
        corners,
        cells: await this.indices(cells),
        obstacle: await this.indices(obstacle),
        times,
        positions: await this.reals(positions),
        offsets: offsets && (await this.reals(offsets)),
      };
    }
  }

  async loadContact(): Promise<void> {
    const data = this.data.contact;
    if (!data) return;
    this.contact = {
      times: data.times,
      nodes: await this.indices(data.nodes),
      position: data.position ? await this.reals(data.position) : new Float64Array(0),
      pieces: data.pieces ?? [],
      quantities: await Promise.all(
        data.quantities.map(async ({ name, values }) => ({ name, values: await this.levels(values) })),
      ),
    };
  }

  async loadBody(): Promise<void> {
    const data = this.data.body;
    if (!data) return;
    const edges = await this.levels(data.edges);
    this.body = {
      dimension: this.summary.dimension,
      nodes: data.nodes,
      triangles: data.triangles,
      times: data.times,
      positions: await this.levels(data.positions),
      corners: await this.indices(data.corners),
      triangleCells: await this.indices(data.triangle_cells),
      edges: Uint8Array.from(edges.levels, (level) => level + edges.low),
      mean: await this.reals(data.mean),
      deviations: await Promise.all(data.deviations.map((each) => this.levels(each))),
      fields: await this.fields(data.fields),
      volume: data.volume ? await this.volume(data.volume) : null,
    };
  }

  private async volume(data: VolumeData): Promise<Volume> {
    const faces = await this.levels(data.faces);
    return {
      nodes: data.nodes,
      positions: await this.levels(data.positions),
      corners: await this.indices(data.corners),
      cells: await this.indices(data.cells),
      faces: Uint8Array.from(faces.levels, (level) => level + faces.low),
      deviations: await Promise.all(data.deviations.map((each) => this.levels(each))),
      fields: await this.fields(data.fields),
    };
  }

  private fields(data: BodyData["fields"]): Promise<Field[]> {
    return Promise.all(data.map(async ({ name, on_nodes, values }) => ({ name, onNodes: on_nodes, values: await this.levels(values) })));
  }

  private async reals(array: PackedArray): Promise<Float64Array> {
    return reals(await this.blobs.get(array.blob));
  }
  private async indices(array: PackedArray): Promise<Int32Array> {
    return indices(await this.blobs.get(array.blob));
  }
  private async levels(array: PackedArray): Promise<Levels> {
    return levels(await this.blobs.get(array.blob), array);
  }
}

function lengths(components: Float64Array[]): Float64Array {
  return Float64Array.from({ length: components[0]?.length ?? 0 }, (_, i) => Math.hypot(...components.map((column) => column[i])));
}

/** Converts the words for numbers that are not finite. */
const withNumbers = (judgement: Judgement): Judgement =>
  Object.fromEntries(Object.entries(judgement).map(([key, value]) => [key, typeof value === "string" && !judgementTexts.has(key) ? toNumber(value) : value])) as unknown as Judgement;

export function readPage(): Run[] {
  if (!("DecompressionStream" in window))
    throw new Error("this browser is too old. Use Chrome 80, Firefox 113, Safari 16.4 or later");
  const text = document.getElementById("ricochet-runs")?.textContent;
  if (!text) throw new Error("this page is the viewer without data. Run `ricochet report` to write a page with runs");
  const page = JSON.parse(text) as PageData;
  if (page.format !== 6) throw new Error(`this viewer does not support data format ${page.format}`);
  const blobs = new Blobs();
  return page.runs.map((run, number) => new Run(number, { ...run, judgement: withNumbers(run.judgement) }, blobs));
}

/** The index of the entry nearest to `value`; without `nearest` the largest index whose entry is at most `value`. */
export function indexAt(sorted: ArrayLike<number>, value: number, nearest = true): number {
  let low = 0;
  let high = sorted.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (sorted[middle] <= value) low = middle;
    else high = middle - 1;
  }
  if (nearest && low + 1 < sorted.length && sorted[low + 1] - value < value - sorted[low]) return low + 1;
  return low;
}
