import type { Volume } from "../data/run";

/** A plane section through tetrahedra in their initial positions, which then moves with the body. */

export interface Section {
  triangles: number;
  /** For each corner the two nodes of its edge, and its position between them, from 0 to 1. */
  from: Int32Array;
  to: Int32Array;
  part: Float32Array;
  /** For each triangle its tetrahedron, and in bit k whether the side from its corner k lies in a facet of the cell. */
  tetrahedra: Int32Array;
  edges: Uint8Array;
}

/** The intersection of each tetrahedron with the plane, a triangle or a quadrilateral. */
export function sectionOf(volume: Volume, reference: Float32Array, axis: number, at: number): Section {
  const from: number[] = [];
  const to: number[] = [];
  const part: number[] = [];
  const tetrahedra: number[] = [];
  const edges: number[] = [];
  const { corners, faces } = volume;
  const above = new Float32Array(4);
  const corner = (t: number, a: number, b: number) => {
    from.push(corners[4 * t + a]);
    to.push(corners[4 * t + b]);
    part.push(above[a] / (above[a] - above[b]));
  };
  /** Adds a triangle with corners on the edges a–b. The side from corner k lies in the face opposite to `sides[k]`, or in none if that is −1. */
  const triangle = (t: number, points: [number, number][], sides: number[]) => {
    for (const [a, b] of points) corner(t, a, b);
    tetrahedra.push(t);
    edges.push(sides.reduce((bits, face, k) => (face >= 0 && (faces[t] >> face) & 1 ? bits | (1 << k) : bits), 0));
  };
  for (let t = 0; 4 * t < corners.length; ++t) {
    const high: number[] = [];
    const low: number[] = [];
    for (let k = 0; k < 4; ++k) {
      above[k] = reference[3 * corners[4 * t + k] + axis] - at;
      (above[k] >= 0 ? high : low).push(k);
    }
    if (high.length === 0 || low.length === 0) continue;
    if (high.length === 2) {
      const [i, j] = high;
      const [k, l] = low;
      triangle(t, [[i, k], [i, l], [j, l]], [j, k, -1]);
      triangle(t, [[i, k], [j, l], [j, k]], [-1, i, l]);
    } else {
      const [[i], [j, k, l]] = high.length === 1 ? [high, low] : [low, high];
      triangle(t, [[i, j], [i, k], [i, l]], [l, j, k]);
    }
  }
  return {
    triangles: tetrahedra.length,
    from: Int32Array.from(from), to: Int32Array.from(to), part: Float32Array.from(part),
    tetrahedra: Int32Array.from(tetrahedra), edges: Uint8Array.from(edges),
  };
}
