// Two linked views on one canvas: the same camera, a mesh on each side.
import {
  Box3, BufferAttribute, BufferGeometry, Color, ColorManagement, LinearSRGBColorSpace,
  PerspectiveCamera, Points, Raycaster, Scene, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { Layers } from "./layers.js";
import { markMaterial } from "./materials.js";
import { theme } from "./palette.js";

ColorManagement.enabled = false;

const FOV_DEG = 32;
const CHOSEN = 0xe6007e;
/** A press that moves less than this many pixels is a click. */
const CLICK_PIXELS = 5;

/** Draws the meshes that `panes` show and tells what is clicked. Throws without WebGL. */
export class Viewer {
  constructor(canvas, panes, onPick) {
    this.canvas = canvas;
    this.panes = panes;
    this.onPick = onPick;
    this.options = { field: null, shading: "flat", liftedDomain: false };
    this.layers = new Map();
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: "high-performance" });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setScissorTest(true);
    this.camera = new PerspectiveCamera(FOV_DEG);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.listenToKeyEvents(canvas);
    this.controls.addEventListener("change", () => this.invalidate());
    this.scene = new Scene();
    this.chosen = [];
    this.frames = 0;
    this.#listen();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  /** Shows `mesh` in pane `i`. */
  setMesh(i, mesh) {
    this.panes[i].mesh = mesh;
    if (!this.layers.has(mesh)) this.layers.set(mesh, new Layers(mesh));
    this.apply();
  }

  layersOf(i) {
    return this.layers.get(this.panes[i].mesh);
  }

  set(options) {
    Object.assign(this.options, options);
    this.apply();
  }

  /** Brings everything up to date with the options and the theme. */
  apply() {
    for (const pane of this.panes) if (pane.mesh) this.layers.get(pane.mesh).show(this.options);
    this.resize();
  }

  /** The whole of the first mesh, from the corner; `up` is "y" or "z". */
  reset(up = this.up ?? "y") {
    this.up = up;
    const direction = up === "y" ? new Vector3(0.52, 0.42, 0.74) : new Vector3(0.52, -0.74, 0.42);
    direction.normalize();
    this.camera.up.set(0, up === "y" ? 1 : 0, up === "z" ? 1 : 0);
    this.home = this.#fit(this.panes[0].mesh.positions, direction);
    this.camera.near = this.home / 1000;
    this.camera.far = this.home * 10;
    this.camera.updateProjectionMatrix();
    this.camera.position.copy(this.controls.target).addScaledVector(direction, this.home);
    this.controls.update();
    this.invalidate();
  }

  /** Aims at the middle of `positions`; the distance from which all of them are in view. */
  #fit(positions, direction) {
    const box = new Box3().setFromArray(positions);
    box.getCenter(this.controls.target);
    const right = this.camera.up.clone().cross(direction).normalize();
    const up = direction.clone().cross(right);
    const slope = Math.tan((FOV_DEG * Math.PI) / 360) / 1.06;
    const arm = new Vector3();
    let distance = 1e-9;
    for (let i = 0; i < positions.length; i += 3) {
      arm.fromArray(positions, i).sub(this.controls.target);
      const wide = Math.abs(arm.dot(right)) / (slope * this.camera.aspect);
      // The heads of the views take some of their height.
      const high = (1.12 * Math.abs(arm.dot(up))) / slope;
      distance = Math.max(distance, arm.dot(direction) + Math.max(wide, high));
    }
    return distance;
  }

  /** Goes in front of a place on the surface. */
  goTo(place, normal, meanEdge) {
    const distance = Math.min(this.home, 26 * meanEdge / Math.tan((FOV_DEG * Math.PI) / 180));
    const target = new Vector3(...place);
    const toward = new Vector3(...normal);
    if (toward.length() < 0.5) toward.copy(this.camera.position).sub(this.controls.target);
    const position = target.clone().addScaledVector(toward.normalize(), distance);
    const from = { target: this.controls.target.clone(), position: this.camera.position.clone() };
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const begin = performance.now();
    const flight = (this.flight = Symbol("flight"));
    const step = (now) => {
      if (this.flight !== flight) return;
      const share = still ? 1 : Math.min(1, Math.max(0, now - begin) / 350);
      const eased = share * share * (3 - 2 * share);
      this.controls.target.lerpVectors(from.target, target, eased);
      this.camera.position.lerpVectors(from.position, position, eased);
      this.controls.update();
      this.invalidate();
      if (share < 1) requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  /** Marks what was chosen in some of the panes: a loop of points, or a single one; or nothing. */
  choose(panes, points) {
    for (const mark of this.chosen) {
      mark.removeFromParent();
      mark.geometry.dispose();
    }
    this.chosen = [];
    for (const layers of points ? new Set(panes.map((i) => this.layersOf(i))) : []) {
      const size = layers.surface.meanEdge;
      const mark = points.length > 1 ? this.#loop(points) : this.#target(points[0], size);
      mark.renderOrder = 2;
      layers.group.add(mark);
      this.chosen.push(mark);
    }
    this.resize();
  }

  #loop(points) {
    const ends = points.flatMap((point, i) => [...point, ...points[(i + 1) % points.length]]);
    const material = new LineMaterial({ color: CHOSEN, linewidth: 3.5, depthTest: false });
    return new LineSegments2(new LineSegmentsGeometry().setPositions(ends), material);
  }

  #target(point, meanEdge) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(Float32Array.from(point), 3));
    const colour = new Color(CHOSEN);
    geometry.setAttribute("tint", new BufferAttribute(Float32Array.of(...colour.toArray()), 3));
    geometry.setAttribute("shape", new BufferAttribute(Float32Array.of(2), 1));
    geometry.setAttribute("grow", new BufferAttribute(Float32Array.of(2.4), 1));
    const material = markMaterial();
    material.depthTest = false;
    material.uniforms.size.value = 0.55 * meanEdge;
    return new Points(geometry, material);
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    const ratio = Math.min(devicePixelRatio, 2);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    const { width, height } = this.panes[0].element.getBoundingClientRect();
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    for (const layers of this.layers.values()) layers.resize(height, ratio, FOV_DEG);
    this.invalidate();
  }

  /** Draws in the next frame. */
  invalidate() {
    this.pending ??= requestAnimationFrame(() => {
      this.pending = null;
      this.#draw();
    });
  }

  #draw() {
    const frame = this.canvas.getBoundingClientRect();
    this.renderer.setClearColor(theme().paper);
    const away = this.camera.position.distanceTo(this.controls.target);
    this.panes.forEach((pane) => {
      const box = pane.element.getBoundingClientRect();
      const [x, y] = [box.left - frame.left, frame.bottom - box.bottom];
      this.renderer.setViewport(x, y, box.width, box.height);
      this.renderer.setScissor(x, y, box.width, box.height);
      // An object has one parent: both sides may show the same mesh, one after the other.
      const layers = this.layers.get(pane.mesh);
      const pixels = box.height / (2 * away * Math.tan((FOV_DEG * Math.PI) / 360));
      layers.fade(layers.surface.meanEdge * pixels);
      this.scene.clear();
      this.scene.add(layers.group);
      this.renderer.render(this.scene, this.camera);
    });
    this.frames += 1;
    // Tells whoever waits for it that there is something to see, and how soon.
    document.documentElement.dataset.frames = this.frames;
    document.documentElement.dataset.firstFrameMs ??= Math.round(performance.now());
  }

  #listen() {
    let pressed = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      this.flight = null;
      pressed = event.isPrimary ? [event.clientX, event.clientY] : null;
    });
    this.canvas.addEventListener("pointerup", (event) => {
      if (!pressed || !event.isPrimary) return;
      const moved = Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]);
      if (moved < CLICK_PIXELS) this.#pick(event.clientX, event.clientY);
      pressed = null;
    });
  }

  #pick(x, y) {
    const inside = (box) => x >= box.left && x < box.right && y >= box.top && y < box.bottom;
    const i = this.panes.findIndex((pane) => inside(pane.element.getBoundingClientRect()));
    if (i < 0) return;
    const box = this.panes[i].element.getBoundingClientRect();
    const place = new Vector2(
      (2 * (x - box.left)) / box.width - 1,
      1 - (2 * (y - box.top)) / box.height,
    );
    const caster = new Raycaster();
    caster.setFromCamera(place, this.camera);
    const { origin, direction } = caster.ray;
    this.onPick(i, this.layersOf(i).surface.hit(origin.toArray(), direction.toArray()));
  }
}
