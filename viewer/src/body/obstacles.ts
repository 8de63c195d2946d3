import * as three from "three";
import { themeColour } from "../colours";
import { indexAt, type Obstacles } from "../data/run";

/** The surfaces of obstacles: in the plane lines with what is behind them, in space sheets, from behind only their borders. */
export class ObstacleView {
  private readonly faces: three.MeshBasicMaterial;
  private readonly lines = new three.LineBasicMaterial();
  private readonly sheets: Sheet[];
  private row = -1;

  /** `middle` of the body at the start: it is on the free side. */
  constructor(
    private readonly obstacles: Obstacles,
    middle: number[],
    size: number,
    scene: three.Object3D,
  ) {
    const { corners, cells, obstacle } = obstacles;
    const plane = corners === 2;
    this.faces = new three.MeshBasicMaterial({ transparent: true, opacity: plane ? 1 : 0.35, side: plane ? three.DoubleSide : three.FrontSide, depthWrite: plane });
    const groups: number[][][] = [];
    obstacle.forEach((number, c) => (groups[number] ??= []).push(Array.from(cells.subarray(c * corners, (c + 1) * corners))));
    this.sheets = Array.from(groups, (own) => new Sheet(own ?? [], obstacle.length === 1, middle, size, this.faces, this.lines, scene));
  }

  /** 1: as it is drawn at first, less: so much of that. */
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
  /** In the plane what is behind the line is behind the body, too. */
  private readonly back: number;

  /** `isAlone`: there is no other cell in the picture. */
  constructor(
    private readonly cells: number[][],
    private readonly isAlone: boolean,
    private readonly middle: number[],
    private readonly size: number,
    faceMaterial: three.MeshBasicMaterial,
    lineMaterial: three.LineBasicMaterial,
    scene: three.Object3D,
  ) {
    const plane = cells[0]?.length === 2;
    const faces = new three.BufferGeometry();
    faces.setAttribute("position", new three.BufferAttribute(new Float32Array(18 * cells.length), 3));
    this.faces = new three.Mesh(faces, faceMaterial);
    const lines = new three.BufferGeometry();
    lines.setAttribute("position", new three.BufferAttribute(new Float32Array((plane ? 6 : 24) * cells.length), 3));
    this.lines = new three.LineSegments(lines, lineMaterial);
    for (const object of [this.faces, this.lines]) {
      object.frustumCulled = false;
      scene.add(object);
    }
    // The body is in front of what is behind an obstacle's line; sheets come last.
    this.back = plane ? -0.001 * size : 0;
    this.faces.position.z = this.back;
    this.faces.renderOrder = plane ? -1 : 2;
  }

  /** From where it is drawn. */
  move(offset: ArrayLike<number>): void {
    this.lines.position.set(offset[0], offset[1], offset[2]);
    this.faces.position.set(offset[0], offset[1], offset[2] + this.back);
  }

  draw(positions: Float64Array): void {
    const point = (i: number) => positions.subarray(3 * i, 3 * i + 3);
    const { cells } = this;
    const faces = this.faces.geometry.attributes.position as three.BufferAttribute;
    const lines = this.lines.geometry.attributes.position as three.BufferAttribute;
    let face = 0;
    let line = 0;
    cells.forEach((cell, c) => {
      let at = cell.map(point);
      if (cell.length === 2 && this.isAlone) at = longer(at[0], at[1]); // a plane goes on beyond the picture
      if (cell.length === 2) {
        const before = c > 0 && cells[c - 1][1] === cell[0] ? cells[c - 1].map(point) : at;
        const after = c + 1 < cells.length && cells[c + 1][0] === cell[1] ? cells[c + 1].map(point) : at;
        const reach = Math.min(this.depth(at, before), this.depth(at, after));
        const behind = [between(at, before, reach), between(at, after, reach)];
        for (const [corner, depth] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]])
          faces.setXYZ(face++, at[corner][0] + depth * behind[corner][0], at[corner][1] + depth * behind[corner][1], 0);
        for (const corner of [0, 1]) lines.setXYZ(line++, at[corner][0], at[corner][1], 0);
      } else {
        // Seen from the free side only: from behind one looks at what touches.
        const order = this.facesBody(at) ? [0, 1, 2, 0, 2, 3] : [0, 2, 1, 0, 3, 2];
        for (const corner of order) faces.setXYZ(face++, at[corner][0], at[corner][1], at[corner][2]);
        for (let k = 0; k < 4; ++k)
          for (const corner of [k, (k + 1) % 4]) lines.setXYZ(line++, at[corner][0], at[corner][1], at[corner][2]);
      }
    });
    faces.needsUpdate = true;
    lines.needsUpdate = true;
  }

  /** By the diagonals: at a pole two corners are the same. */
  private facesBody([a, b, c, d]: Float64Array[]): boolean {
    const at = (p: ArrayLike<number>) => new three.Vector3(p[0], p[1], p[2]);
    const normal = at(c).sub(at(a)).cross(at(d).sub(at(b)));
    return normal.dot(at(this.middle).sub(at(a))) > 0;
  }

  /** How far an obstacle's line is shown into the obstacle, which is to its right: not beyond the middle of a round one. */
  private depth(piece: Float64Array[], other: Float64Array[]): number {
    const [own, next] = [rightOf(piece), rightOf(other)];
    const apart = [other[0][0] - piece[0][0], other[0][1] - piece[0][1]];
    const isRound = apart[0] * (next[0] - own[0]) + apart[1] * (next[1] - own[1]) < 0;
    const radius = Math.hypot(apart[0], apart[1]) / Math.hypot(own[0] - next[0], own[1] - next[1]);
    return isRound ? Math.min(4 * this.size, 0.95 * radius) : 4 * this.size;
  }
}

/** Into the obstacle where two pieces meet, so that both end on the same line. */
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
