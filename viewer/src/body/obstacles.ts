import * as three from "three";
import { themeColour } from "../colours";
import { indexAt, type Obstacles } from "../data/run";

/** The surfaces of obstacles: in the plane lines with what is behind them, in space sheets, from behind only their borders. */
export class ObstacleView {
  private readonly faces: three.Mesh<three.BufferGeometry, three.MeshBasicMaterial>;
  private readonly lines: three.LineSegments<three.BufferGeometry, three.LineBasicMaterial>;
  private row = -1;

  /** `middle` of the body at the start: it is on the free side. */
  constructor(
    private readonly obstacles: Obstacles,
    private readonly middle: number[],
    private readonly size: number,
    scene: three.Object3D,
  ) {
    const cells = obstacles.cells.length / obstacles.corners;
    const plane = obstacles.corners === 2;
    const faces = new three.BufferGeometry();
    faces.setAttribute("position", new three.BufferAttribute(new Float32Array(18 * cells), 3));
    this.faces = new three.Mesh(faces, new three.MeshBasicMaterial({ transparent: true, opacity: plane ? 1 : 0.35, side: plane ? three.DoubleSide : three.FrontSide, depthWrite: plane }));
    const lines = new three.BufferGeometry();
    lines.setAttribute("position", new three.BufferAttribute(new Float32Array((plane ? 6 : 24) * cells), 3));
    this.lines = new three.LineSegments(lines, new three.LineBasicMaterial());
    for (const object of [this.faces, this.lines]) {
      object.frustumCulled = false;
      scene.add(object);
    }
    // The body is in front of what is behind an obstacle's line; sheets come last.
    if (plane) this.faces.position.z = -0.001 * size;
    this.faces.renderOrder = plane ? -1 : 2;
  }

  /** 1: as it is drawn at first, less: so much of that. */
  fade(part: number): void {
    const plane = this.obstacles.corners === 2;
    this.faces.material.opacity = part * (plane ? 1 : 0.35);
  }

  recolour(): void {
    this.faces.material.color.setStyle(themeColour("obstacle"));
    this.lines.material.color.setStyle(themeColour("muted"));
  }

  update(time: number): void {
    const { times, positions, corners, cells } = this.obstacles;
    const row = indexAt(times, time);
    if (row === this.row) return;
    this.row = row;
    const numbers = positions.length / times.length;
    const point = (i: number) => positions.subarray(row * numbers + 3 * i, row * numbers + 3 * i + 3);
    const faces = this.faces.geometry.attributes.position as three.BufferAttribute;
    const lines = this.lines.geometry.attributes.position as three.BufferAttribute;
    let face = 0;
    let line = 0;
    for (let c = 0; c < cells.length; c += corners) {
      let at = cells.slice(c, c + corners).map(point);
      if (corners === 2 && cells.length === 2) at = longer(at[0], at[1]); // a plane goes on beyond the picture
      if (corners === 2) {
        const before = c >= 2 && cells[c - 1] === cells[c] ? cells.slice(c - 2, c).map(point) : at;
        const after = c + 3 < cells.length && cells[c + 2] === cells[c + 1] ? cells.slice(c + 2, c + 4).map(point) : at;
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
    }
    faces.needsUpdate = true;
    lines.needsUpdate = true;
  }

  private facesBody([a, b, c]: Float64Array[]): boolean {
    const at = (p: ArrayLike<number>) => new three.Vector3(p[0], p[1], p[2]);
    const normal = at(b).sub(at(a)).cross(at(c).sub(at(a)));
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
