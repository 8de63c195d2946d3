import * as three from "three";
import { themeColour } from "../colours";
import { indexAt, type Obstacles } from "../data/run";
import { diagonal, type Box } from "./geometry";

/** The surfaces of obstacles: in the plane lines with the area behind them; in space sheets, of which only the borders are seen from behind. */
export class ObstacleView {
  private readonly faces: three.MeshBasicMaterial;
  private readonly lines = new three.LineBasicMaterial();
  private readonly sheets: Sheet[];
  private row = -1;

  /** `box`: around the body at all times; `size`: of the body at the start. */
  constructor(
    private readonly obstacles: Obstacles,
    box: Box,
    size: number,
    scene: three.Object3D,
  ) {
    const { corners, cells, obstacle } = obstacles;
    const plane = corners === 2;
    this.faces = new three.MeshBasicMaterial({ transparent: true, opacity: plane ? 1 : 0.35, side: plane ? three.DoubleSide : three.FrontSide, depthWrite: plane, vertexColors: !plane });
    const groups: number[][][] = [];
    obstacle.forEach((number, c) => (groups[number] ??= []).push(Array.from(cells.subarray(c * corners, (c + 1) * corners))));
    this.sheets = Array.from(groups, (own) => new Sheet(own ?? [], obstacle.length === 1, box, size, this.faces, this.lines, scene));
  }

  /** Draws the faces with this fraction of their usual opacity. */
  fade(part: number): void {
    const plane = this.obstacles.corners === 2;
    this.faces.opacity = part * (plane ? 1 : 0.35);
  }

  recolour(): void {
    this.faces.color.setStyle(themeColour("obstacle"));
    this.lines.color.setStyle(themeColour("muted"));
  }

  update(time: number): void {
    const { times, positions, offsets } = this.obstacles;
    const row = indexAt(times, time);
    if (row === this.row) return;
    const isFirst = this.row < 0;
    this.row = row;
    if (isFirst || !offsets) {
      const numbers = positions.length / (offsets ? 1 : times.length);
      const shown = offsets ? positions : positions.subarray(row * numbers, (row + 1) * numbers);
      for (const sheet of this.sheets) sheet.draw(shown);
    }
    if (!offsets) return;
    const width = offsets.length / times.length;
    this.sheets.forEach((sheet, k) => sheet.move(offsets.subarray(row * width + 3 * k, row * width + 3 * k + 3)));
  }
}

/** The surface of one obstacle. */
class Sheet {
  private readonly faces: three.Mesh<three.BufferGeometry, three.MeshBasicMaterial>;
  private readonly lines: three.LineSegments<three.BufferGeometry, three.LineBasicMaterial>;
  /** Depth of the faces: in the plane the area behind the line is drawn behind the body. */
  private readonly back: number;
  private bends: boolean[] | null = null;
  /** The part of a plane in space that is shown, along its first and its last side. */
  private part: { from: [number, number]; to: [number, number] } | null = null;

  /** `isAlone`: the picture has no other cell. */
  constructor(
    private readonly cells: number[][],
    private readonly isAlone: boolean,
    private readonly box: Box,
    private readonly size: number,
    faceMaterial: three.MeshBasicMaterial,
    lineMaterial: three.LineBasicMaterial,
    scene: three.Object3D,
  ) {
    const plane = cells[0]?.length === 2;
    const faces = new three.BufferGeometry();
    faces.setAttribute("position", new three.BufferAttribute(new Float32Array(18 * cells.length), 3));
    if (!plane) faces.setAttribute("color", new three.BufferAttribute(new Float32Array(18 * cells.length).fill(1), 3));
    this.faces = new three.Mesh(faces, faceMaterial);
    const lines = new three.BufferGeometry();
    lines.setAttribute("position", new three.BufferAttribute(new Float32Array((plane ? 6 : 24) * cells.length), 3));
    this.lines = new three.LineSegments(lines, lineMaterial);
    for (const object of [this.faces, this.lines]) {
      object.frustumCulled = false;
      scene.add(object);
    }
    // The body is drawn in front of the area behind an obstacle's line; sheets are drawn last.
    this.back = plane ? -0.001 * size : 0;
    this.faces.position.z = this.back;
    this.faces.renderOrder = plane ? -1 : 2;
  }

  /** Moves the sheet by this offset from its drawn position. */
  move(offset: ArrayLike<number>): void {
    this.lines.position.set(offset[0], offset[1], offset[2]);
    this.faces.position.set(offset[0], offset[1], offset[2] + this.back);
  }

  draw(positions: Float64Array): void {
    const point = (i: number) => positions.subarray(3 * i, 3 * i + 3);
    const { cells } = this;
    const faces = this.faces.geometry.attributes.position as three.BufferAttribute;
    const lines = this.lines.geometry.attributes.position as three.BufferAttribute;
    const shades = this.faces.geometry.attributes.color as three.BufferAttribute | undefined;
    const bends = (this.bends ??= this.findBends(point));
    let face = 0;
    let line = 0;
    cells.forEach((cell, c) => {
      let at = cell.map(point);
      if (cells.length === 1 && cell.length === 4 && cell[2] !== cell[3]) at = this.besideBody(at);
      if (cell.length === 2 && this.isAlone) at = longer(at[0], at[1]); // a plane extends beyond the picture
      if (cell.length === 2) {
        const before = c > 0 && cells[c - 1][1] === cell[0] ? cells[c - 1].map(point) : at;
        const after = c + 1 < cells.length && cells[c + 1][0] === cell[1] ? cells[c + 1].map(point) : at;
        const reach = Math.min(this.depth(at, before), this.depth(at, after));
        const behind = [between(at, before, reach), between(at, after, reach)];
        for (const [corner, depth] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]])
          faces.setXYZ(face++, at[corner][0] + depth * behind[corner][0], at[corner][1] + depth * behind[corner][1], 0);
        for (const corner of [0, 1]) lines.setXYZ(line++, at[corner][0], at[corner][1], 0);
      } else {
        // Counterclockwise seen from the free side. From behind the sheet is invisible, and the contact zone is seen.
        const shade = light(normalOf(at));
        for (const corner of [0, 1, 2, 0, 2, 3]) {
          shades?.setXYZ(face, shade, shade, shade);
          faces.setXYZ(face++, at[corner][0], at[corner][1], at[corner][2]);
        }
        for (let k = 0; k < 4; ++k)
          for (const corner of bends[4 * c + k] ? [k, (k + 1) % 4] : [0, 0]) lines.setXYZ(line++, at[corner][0], at[corner][1], at[corner][2]);
      }
    });
    if (shades) shades.needsUpdate = true;
    faces.needsUpdate = true;
    lines.needsUpdate = true;
  }

  /** Whether a line is drawn on each side of each cell: on all sides of a grid; on sides of triangles from a file where the surface bends or ends. */
  private findBends(point: (i: number) => Float64Array): boolean[] {
    const sides = new Map<string, three.Vector3[]>();
    const keyOf = (cell: number[], k: number) => [cell[k], cell[(k + 1) % 4]].sort((a, b) => a - b).join();
    for (const cell of this.cells.filter(isTriangle)) {
      const normal = normalOf(cell.map(point));
      for (let k = 0; k < 4; ++k) sides.set(keyOf(cell, k), [...(sides.get(keyOf(cell, k)) ?? []), normal]);
    }
    return this.cells.flatMap((cell) => [0, 1, 2, 3].map((k) => {
      if (!isTriangle(cell)) return true;
      const normals = sides.get(keyOf(cell, k))!;
      return cell[k] !== cell[(k + 1) % 4] && (normals.length !== 2 || normals[0].dot(normals[1]) < sharp);
    }));
  }

  /** The shown part of an infinite plane: the extent of the body over time, with a margin. */
  private besideBody([a, b, , d]: Float64Array[]): Float64Array[] {
    const sides = [b, d].map((corner) => corner.map((value, k) => value - a[k]));
    this.part ??= this.partOf(a, sides);
    const { from, to } = this.part;
    const at = (first: number, last: number) => a.map((value, k) => value + first * sides[0][k] + last * sides[1][k]);
    return [at(from[0], from[1]), at(to[0], from[1]), at(to[0], to[1]), at(from[0], to[1])];
  }

  private partOf(a: Float64Array, sides: Float64Array[]): { from: [number, number]; to: [number, number] } {
    const margin = planeMargin * Math.max(this.size, 0.5 * diagonal(this.box));
    const ranges = sides.map((side) => {
      const square = dot(side, side);
      const places: number[] = [];
      for (let corner = 0; corner < 8; ++corner) {
        const place = a.map((value, k) => (corner & (1 << k) ? this.box.high : this.box.low)[k] - value);
        places.push(dot(place, side) / square);
      }
      const more = margin / Math.sqrt(square);
      return [Math.min(...places) - more, Math.max(...places) + more] as const;
    });
    return { from: [ranges[0][0], ranges[1][0]], to: [ranges[0][1], ranges[1][1]] };
  }

  /** Width of the area shown behind an obstacle's line, to its right; it does not exceed the radius of a round obstacle. */
  private depth(piece: Float64Array[], other: Float64Array[]): number {
    const [own, next] = [rightOf(piece), rightOf(other)];
    const apart = [other[0][0] - piece[0][0], other[0][1] - piece[0][1]];
    const isRound = apart[0] * (next[0] - own[0]) + apart[1] * (next[1] - own[1]) < 0;
    const radius = Math.hypot(apart[0], apart[1]) / Math.hypot(own[0] - next[0], own[1] - next[1]);
    return isRound ? Math.min(4 * this.size, 0.95 * radius) : 4 * this.size;
  }
}

/** Margin of a plane, relative to the size of the body. */
const planeMargin = 0.2;
/** Cosine of the angle above which an edge is drawn. */
const sharp = Math.cos((25 * Math.PI) / 180);
const lightFrom = new three.Vector3(0.3, -0.5, 0.8).normalize();

const isTriangle = (cell: number[]) => cell.length === 4 && cell[2] === cell[3];

/** Normal from the diagonals, because two corners coincide at a pole and in a triangle. */
function normalOf([a, b, c, d]: Float64Array[]): three.Vector3 {
  const at = (p: Float64Array) => new three.Vector3(p[0], p[1], p[2]);
  return at(c).sub(at(a)).cross(at(d).sub(at(b))).normalize();
}

const light = (normal: three.Vector3) => 0.55 + 0.45 * Math.max(normal.dot(lightFrom), 0);

const dot = (a: Float64Array, b: Float64Array) => a.reduce((sum, value, k) => sum + value * b[k], 0);

/** Vector into the obstacle where two pieces meet, the same for both. */
function between(piece: Float64Array[], other: Float64Array[], depth: number): [number, number] {
  const [own, next] = [rightOf(piece), rightOf(other)];
  return [0.5 * depth * (own[0] + next[0]), 0.5 * depth * (own[1] + next[1])];
}

function rightOf([a, b]: Float64Array[]): [number, number] {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
  return [(b[1] - a[1]) / length, (a[0] - b[0]) / length];
}

function longer(a: Float64Array, b: Float64Array): Float64Array[] {
  const along = (part: number) => a.map((value, k) => value + part * (b[k] - value));
  return [along(-4), along(5)];
}
