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
        const behind = this.behind(at[0], at[1]);
        for (const [corner, depth] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]])
          faces.setXYZ(face++, at[corner][0] + depth * behind[0], at[corner][1] + depth * behind[1], 0);
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

  /** From an obstacle's line into the obstacle: away from the body. */
  private behind(a: Float64Array, b: Float64Array): [number, number] {
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    const normal: [number, number] = [(a[1] - b[1]) / length, (b[0] - a[0]) / length];
    const side = normal[0] * (this.middle[0] - a[0]) + normal[1] * (this.middle[1] - a[1]) > 0 ? -1 : 1;
    return [side * normal[0] * 4 * this.size, side * normal[1] * 4 * this.size];
  }
}

function longer(a: Float64Array, b: Float64Array): Float64Array[] {
  const along = (part: number) => a.map((value, k) => value + part * (b[k] - value));
  return [along(-4), along(5)];
}
