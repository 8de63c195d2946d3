import * as three from "three";

type Drawn = three.Mesh | three.LineSegments;

/** Mirror image of the section through an axisymmetric body, beyond the axis x = 0; with it the body is whole. */
export class MirrorImage {
  private readonly group = new three.Group();
  private readonly images = new Map<Drawn, Drawn>();

  /** Mirrors all meshes and lines that `content` has now. */
  constructor(content: three.Object3D) {
    for (const own of [...content.children]) {
      if (!(own instanceof three.Mesh) && !(own instanceof three.LineSegments)) continue;
      const image = own.clone();
      image.frustumCulled = false;
      this.images.set(own, image);
      this.group.add(image);
    }
    this.group.scale.x = -1;
    content.add(this.group);
  }

  /** Adopts the positions and the visibility of the originals. */
  update(isShown: boolean): void {
    this.group.visible = isShown;
    for (const [own, image] of this.images) {
      image.position.copy(own.position);
      image.visible = own.visible;
    }
  }

  /** The image of an object; undefined if it is not shown. */
  of(own: Drawn): Drawn | undefined {
    return this.group.visible ? this.images.get(own) : undefined;
  }
}
