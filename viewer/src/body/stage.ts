import * as three from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { themeColour } from "../colours";
import type { Run } from "../data/run";
import { el } from "../elements";
import { fieldName, number, statusNames } from "../format";
import { colourBar, colourKey } from "../maps/colour_bar";
import { fileName, saveCanvas, withCaption } from "../save";
import type { Store } from "../store";
import { diagonal, emptyBox, join, type Box } from "./geometry";
import { BodyView } from "./view";

/** The panel that shows the body of one run. */
export interface BodyPanel {
  element: HTMLElement;
  view: BodyView;
  canvas: HTMLCanvasElement;
  renderer: three.WebGLRenderer | null;
  message: HTMLElement;
  tip: HTMLElement;
  lens: Lens;
  /** The part of space that it shows: its centre, size, and width and height as fractions of the size. */
  home: { centre: three.Vector3; size: number; sides: [number, number] };
  caption: () => void;
}

export type View = keyof typeof directions | "contact" | "contact-side";

/** Directions from solids to the camera; "x", "y" and "z" for a cut across that axis. */
const directions = {
  front: [0.5, -1, 0.28], side: [1, 0, 0.05], top: [0.001, -0.01, 1], below: [0.25, -0.5, -1],
  x: [1, -0.45, 0.3], y: [0.4, -1, 0.3], z: [0.3, -0.6, 1],
} satisfies Record<string, [number, number, number]>;

/** Vertical field of view in degrees. */
const fieldOfView = 32;

/** Whether two boxes have about the same size and position. */
function sameBody(a: Box, b: Box): boolean {
  const sizes = [diagonal(a), diagonal(b)];
  const apart = Math.hypot(...a.low.map((low, k) => (low + a.high[k] - b.low[k] - b.high[k]) / 2));
  return Math.max(...sizes) <= 1.5 * Math.min(...sizes) && apart <= 0.5 * Math.min(...sizes);
}

/** Largest number of WebGL contexts; browsers allow 16 in a page. */
const mostRenderers = 12;

/** The camera of all plane bodies, or of all bodies in space, and its controls. */
interface Lens {
  camera: three.OrthographicCamera | three.PerspectiveCamera;
  target: three.Vector3;
  controls: OrbitControls[];
}

function makeLens(plane: boolean): Lens {
  const camera = plane ? new three.OrthographicCamera(-1, 1, 1, -1, 0.1, 10) : new three.PerspectiveCamera(fieldOfView, 1, 0.1, 10);
  camera.up.set(0, plane ? 1 : 0, plane ? 0 : 1);
  return { camera, target: new three.Vector3(), controls: [] };
}

/** Draws all bodies. */
export class Stage {
  readonly panels: BodyPanel[] = [];
  /** Pictures drawn so far. */
  pictures = 0;
  private readonly antialias: boolean;
  private readonly lenses = { plane: makeLens(true), space: makeLens(false) };
  /** Whether panels show the contact zones. */
  private onZone = false;
  private zoneLength = 0;
  private waiting = false;
  private stale = true;

  constructor(private readonly store: Store) {
    for (const topic of ["time", "runs", "body", "theme", "contact"] as const) store.on(topic, () => this.redraw(true));
    const triangles = store.runs.reduce((sum, run) => sum + (run.body?.triangles ?? 0), 0);
    // Without a graphics card, antialiasing would need two thirds of the time.
    this.antialias = triangles < 20_000 || !drawsInSoftware();
  }

  add(run: Run): BodyPanel {
    const view = new BodyView(run, this.store);
    const lens = run.summary.dimension === 2 ? this.lenses.plane : this.lenses.space;
    const canvas = el("canvas", { tabIndex: 0, role: "img", "aria-label": `Body of ${run.name}` });
    const tip = el("div.tip", { hidden: true });
    const message = el("p.note", { hidden: true });
    const time = el("span.muted");
    const colours = el("div");
    const area = el("div.body-area", {}, canvas, tip, message);
    const element = el("div.body", {}, area, el("div.body-foot", {}, time,
      el("button.small", { type: "button", title: "Save the picture", onclick: () => {
        this.draw();
        saveCanvas(withCaption(panel.canvas, `${run.name}, t = ${number(this.store.time, 4)}`, [], themeColour("panel"), themeColour("text"),
          view.values && colourKey(fieldName(this.store.field), view.values.isStatus ? null : view.range)), `${fileName(run.name)}-body.png`);
      } }, "PNG")), colours);
    const { store } = this;
    const caption = () => {
      const at = run.body!.times[view.frame] ?? 0;
      time.textContent = `t = ${number(at, 5)}, contact force ${number(run.resultantAt(at), 4)}`;
      const name = fieldName(this.store.field);
      if (!view.values) colours.replaceChildren();
      else colours.replaceChildren(colourBar(name, view.values.isStatus ? null : view.range));
      const peak = run.summary.peak_stress;
      if (peak && store.field === "von_mises") colours.append(el("div.peak-note", {}, el("i"), `largest ${number(peak.von_mises, 4)} at `,
        el("button.link", { type: "button", onclick: () => this.showPeak(run) }, `t = ${number(peak.time, 4)}`)));
    };
    const panel: BodyPanel = { element, view, canvas, renderer: null, message, tip, lens, home: { centre: new three.Vector3(), size: 1, sides: [1, 1] }, caption };
    this.panels.push(panel);
    this.connect(panel);
    this.fit();
    new ResizeObserver(() => this.redraw(false)).observe(area);
    return panel;
  }

  private connect(panel: BodyPanel): void {
    const { canvas, lens } = panel;
    const plane = lens === this.lenses.plane;
    const controls = new OrbitControls(lens.camera, canvas);
    controls.target = lens.target;
    controls.enableZoom = false; // the wheel scrolls the page until the panel has the focus
    controls.screenSpacePanning = true;
    if (plane) {
      controls.enableRotate = false;
      controls.mouseButtons.LEFT = three.MOUSE.PAN;
    }
    controls.touches = { ONE: plane ? three.TOUCH.PAN : three.TOUCH.ROTATE, TWO: plane ? three.TOUCH.DOLLY_PAN : three.TOUCH.DOLLY_ROTATE };
    controls.addEventListener("change", () => this.redraw(false));
    canvas.addEventListener("focus", () => (controls.enableZoom = true));
    canvas.addEventListener("blur", () => (controls.enableZoom = false));
    canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
    canvas.addEventListener("dblclick", () => this.look("front"));
    canvas.style.touchAction = "pan-y";
    lens.controls.push(controls);
    canvas.addEventListener("pointermove", (event) => this.showValue(panel, event));
    canvas.addEventListener("pointerleave", () => (panel.tip.hidden = true));
  }

  /**
   * Chooses the part of space that each panel shows, scaled to size 1. Runs of one body show the same part, which contains
   * the motion of all of them except those that fly far away. Other bodies have parts of their own.
   */
  private fit(): void {
    const groups: BodyPanel[][] = [];
    for (const panel of this.panels) {
      const group = groups.find(([first]) => first.lens === panel.lens && sameBody(first.view.start, panel.view.start));
      if (group) group.push(panel);
      else groups.push([panel]);
    }
    for (const group of groups) {
      const boxes = group.map(({ view }) => view.box);
      const smallest = Math.min(...boxes.map(diagonal));
      const box = boxes.filter((each) => diagonal(each) <= 1.5 * smallest).reduce(join, emptyBox());
      const size = diagonal(box) || 1;
      // Room for the bars of pressure below.
      if (group[0].lens === this.lenses.plane) box.low[1] -= 0.16 * size;
      const centre = new three.Vector3(...(box.low.map((low, k) => (low + box.high[k]) / 2) as [number, number, number]));
      for (const panel of group) {
        panel.home = { centre, size, sides: [(box.high[0] - box.low[0]) / size, (box.high[1] - box.low[1]) / size] };
      }
    }
    this.look("front");
  }

  /** Sets the view; "contact" shows the contact zone from inside the obstacle, "contact-side" along the obstacle. */
  look(from: View): void {
    this.onZone = from.startsWith("contact");
    // One scale for all zones, that of the largest one, so that they can be compared.
    this.zoneLength = 2.6 * Math.max(0, ...this.panels.map(({ view }) => view.zone?.radius ?? 0));
    for (const { view, home } of this.panels) {
      view.place(home.centre, home.size);
      view.showObstacles(this.onZone ? 0.4 : 1);
    }
    for (const lens of [this.lenses.plane, this.lenses.space]) {
      const plane = lens === this.lenses.plane;
      const direction = plane ? new three.Vector3(0, 0, 1) : this.directionOf(from).normalize();
      // In space the ball around the part of size 1 just fits.
      const distance = plane ? 2 : 0.52 / Math.sin((0.5 * fieldOfView * Math.PI) / 180);
      lens.target.set(0, 0, 0);
      lens.camera.position.copy(direction).multiplyScalar(distance);
      lens.camera.near = 0.02;
      lens.camera.far = 20;
      lens.camera.zoom = 1;
      lens.camera.lookAt(lens.target);
      for (const controls of lens.controls) controls.update();
    }
    this.redraw(false);
  }

  /** Goes to the time of a run's largest stress and cuts solids at its position. */
  showPeak(run: Run): void {
    const { store } = this;
    const peak = run.summary.peak_stress;
    const panel = this.panels.find(({ view }) => view.run === run);
    if (!peak || !panel) return;
    store.setTime(peak.time);
    store.set("field", "von_mises", "body");
    const { start, section } = panel.view;
    if (section) {
      store.set("cut", "y", "body");
      store.set("cutFlipped", false, "body");
      store.set("cutAt", Math.min(Math.max((peak.place[1] - start.low[1]) / (start.high[1] - start.low[1]), 0), 1), "body");
      this.look("y");
    }
    panel.element.scrollIntoView({ block: "nearest" });
  }

  private directionOf(from: View): three.Vector3 {
    if (from === "contact" || from === "contact-side") {
      const first = this.panels.find(({ lens, view, element }) => lens === this.lenses.space && view.zone && element.offsetParent !== null);
      if (first && first.view.frame < 0) first.view.update();
      const out = first?.view.zoneNormal() ?? new three.Vector3(0, 0, -1);
      const front = new three.Vector3(0.4, -1, 0.1);
      const along = front.clone().addScaledVector(out, -front.dot(out) / (out.lengthSq() || 1)).normalize();
      return from === "contact" ? out.normalize().addScaledVector(along, 0.5) : along.addScaledVector(out.normalize(), 0.12);
    }
    return new three.Vector3(...directions[from]);
  }

  redraw(stale: boolean): void {
    this.stale ||= stale;
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
    });
  }

  draw(): void {
    const scale = devicePixelRatio;
    let drew = false;
    for (const panel of this.panels) {
      const { view, canvas } = panel;
      const width = canvas.clientWidth;
      const height = canvas.clientHeight;
      if (width === 0 || height === 0) {
        this.release(panel); // hidden
        continue;
      }
      if (this.stale || view.frame < 0) view.update();
      if (this.onZone && this.zoneLength > 0) view.placeOnZone(this.zoneLength);
      panel.caption();
      panel.renderer ??= this.makeRenderer(panel);
      const { renderer } = panel;
      if (!renderer) continue;
      const size = renderer.getSize(new three.Vector2());
      const [wide, high] = [Math.round(width * scale), Math.round(height * scale)];
      if (size.x !== wide || size.y !== high) renderer.setSize(wide, high, false);
      this.frameCamera(panel, width / height);
      view.markPeak(panel.lens.camera);
      renderer.setClearColor(new three.Color().setStyle(themeColour("panel")));
      renderer.render(view.scene, panel.lens.camera);
      drew = true;
    }
    this.stale = false;
    if (drew) ++this.pictures;
  }

  private makeRenderer(panel: BodyPanel): three.WebGLRenderer | null {
    const there = this.panels.filter(({ renderer }) => renderer !== null).length;
    let problem = there < mostRenderers ? "" : "Too many bodies at once. Hide some runs.";
    let renderer: three.WebGLRenderer | null = null;
    try {
      if (problem === "") renderer = new three.WebGLRenderer({ canvas: panel.canvas, antialias: this.antialias });
    } catch {
      problem = "The animation needs WebGL, which this browser does not support.";
    }
    panel.message.textContent = problem;
    panel.message.hidden = problem === "";
    return renderer;
  }

  /** Frees the WebGL context of a hidden panel. */
  private release(panel: BodyPanel): void {
    if (!panel.renderer || this.panels.length <= mostRenderers) return;
    panel.renderer.dispose();
    panel.renderer.forceContextLoss();
    panel.renderer = null;
    // A canvas keeps its first context forever, so it is replaced.
    const fresh = panel.canvas.cloneNode() as HTMLCanvasElement;
    panel.canvas.replaceWith(fresh);
    panel.canvas = fresh;
    this.connect(panel);
  }

  private frameCamera({ home, view, lens: { camera } }: BodyPanel, aspect: number): void {
    if (camera instanceof three.OrthographicCamera) {
      const sides = this.onZone && view.zone ? [1, 0.5] : home.sides;
      const half = 0.55 * Math.max(sides[1], sides[0] / aspect);
      camera.top = half;
      camera.bottom = -half;
      camera.left = -half * aspect;
      camera.right = half * aspect;
    } else {
      camera.aspect = aspect;
    }
    camera.updateProjectionMatrix();
  }

  private showValue(panel: BodyPanel, event: PointerEvent): void {
    const { view, canvas, tip } = panel;
    if (event.buttons !== 0 || this.store.playing) {
      tip.hidden = true;
      return;
    }
    const box = canvas.getBoundingClientRect();
    this.frameCamera(panel, box.width / box.height);
    const ray = new three.Raycaster();
    ray.setFromCamera(new three.Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height), panel.lens.camera);
    const hit = view.pick(ray);
    tip.hidden = !hit;
    if (!hit) return;
    const place = hit.place.toArray().slice(0, panel.lens === this.lenses.plane ? 2 : 3).map((x) => number(x, 3)).join(", ");
    const value = !view.values ? "" : view.values.isStatus ? `${statusNames[Math.round(hit.value) + 1] ?? "off the boundary"} · ` : `${fieldName(this.store.field)} ${number(hit.value, 4)} · `;
    tip.textContent = `${value}at (${place})`;
    tip.style.left = `${Math.min(event.clientX - box.left + 12, box.width - 180)}px`;
    tip.style.top = `${event.clientY - box.top + 14}px`;
  }
}

function drawsInSoftware(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  const extension = context?.getExtension("WEBGL_debug_renderer_info");
  if (!context || !extension) return false;
  const name = String(context.getParameter(extension.UNMASKED_RENDERER_WEBGL));
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}
