import * as three from "three";
import type { Run } from "../data/run";

/** A ring around the position of the largest stress, drawn over everything. */
export class PeakMarker {
  readonly sprite: three.Sprite;
  private readonly node: number;

  /** `reference`: initial positions of the nodes; the ring follows the nearest one. */
  constructor(run: Run, private readonly reference: Float32Array) {
    const place = run.summary.peak_stress!.place;
    this.place = [0, 1, 2].map((k) => place[k] ?? 0);
    this.node = nearest(reference, this.place);
    this.sprite = new three.Sprite(new three.SpriteMaterial({ map: ring(), depthTest: false, depthWrite: false, sizeAttenuation: false, transparent: true }));
    this.sprite.renderOrder = 5;
  }
  readonly place: number[];

  /** Moves the ring with its node. `faint`: at times other than that of the largest stress. */
  update(positions: Float32Array, content: three.Object3D, faint: boolean): void {
    const now = this.place.map((x, k) => x + positions[3 * this.node + k] - this.reference[3 * this.node + k]);
    content.localToWorld(this.sprite.position.fromArray(now));
    this.sprite.material.opacity = faint ? 0.35 : 1;
  }

  /** Keeps the size of the ring on the screen. */
  scaleFor(camera: three.OrthographicCamera | three.PerspectiveCamera): void {
    const height = camera instanceof three.OrthographicCamera ? (camera.top - camera.bottom) / camera.zoom : 2 * Math.tan((camera.fov * Math.PI) / 360) / camera.zoom;
    this.sprite.scale.setScalar(0.09 * height);
  }
}

function nearest(positions: Float32Array, place: number[]): number {
  let best = 0;
  let least = Infinity;
  for (let i = 0; i < positions.length / 3; ++i) {
    const distance = Math.hypot(...place.map((x, k) => x - positions[3 * i + k]));
    if (distance < least) [least, best] = [distance, i];
  }
  return best;
}

/** A dark ring between two light ones, visible on every colour. */
function ring(): three.CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 96;
  const context = canvas.getContext("2d")!;
  for (const [colour, width] of [["#ffffff", 15], ["#d1006c", 8]] as const) {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    context.arc(48, 48, 36, 0, 2 * Math.PI);
    context.stroke();
  }
  const texture = new three.CanvasTexture(canvas);
  texture.colorSpace = three.SRGBColorSpace;
  return texture;
}
