// What is drawn of one mesh: faces, edges, lines, marks, each as an object of three.
import {
  BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, Mesh, Points,
} from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { faceMaterial, markMaterial } from "./materials.js";
import { T_JUNCTION, heat, ofIndex, theme } from "./palette.js";
import { Surface } from "./surface.js";

/** Everything that is drawn of `mesh`; made when it is first looked at. */
export class Layers {
  constructor(mesh) {
    this.mesh = mesh;
    this.surface = new Surface(mesh);
    this.group = new Group();
    this.primal = new Group();
    this.lifted = null;
    this.lineMaterials = [];
    this.#faces();
    this.#edges();
    this.#strongLines();
    this.marks = this.#marks([...this.#vertexMarks()]);
    this.primal.add(this.marks);
    this.group.add(this.primal);
  }

  /** Applies what was chosen: `{ field, shading, liftedDomain }`. */
  show(options) {
    if (options.liftedDomain && !this.lifted) this.#lift();
    this.primal.visible = !options.liftedDomain;
    if (this.lifted) this.lifted.visible = options.liftedDomain;
    const solid = options.shading !== "wireframe";
    this.faces.visible = solid;
    if (this.liftedFaces) this.liftedFaces.visible = solid;
    this.#shade(options.shading === "smooth");
    this.#tint(options.field);
    this.marks.visible = !options.field;
    for (const { material, role } of this.lineMaterials) material.color.set(theme()[role]);
  }

  /** Pixels of the view, for lines and marks that are measured in pixels. */
  resize(height, ratio, fovDeg) {
    for (const points of this.group.getObjectsByProperty("isPoints", true)) {
      const uniforms = points.material.uniforms;
      uniforms.scale.value = (height * ratio) / (2 * Math.tan((fovDeg * Math.PI) / 360));
      uniforms.ratio.value = ratio;
    }
  }

  /** Thins out lines that are only so many pixels from one another, so that faces still show. */
  fade(pixels) {
    for (const { material, role } of this.lineMaterials) {
      if (role === "edge") material.opacity = Math.min(1, Math.max(0.18, pixels / 10));
    }
  }

  #faces() {
    const { corners, faces } = this.surface.triangles;
    const positions = new Float32Array(3 * corners.length);
    corners.forEach((c, i) => positions.set(this.surface.corner(c), 3 * i));
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(positions, 3));
    geometry.setAttribute("tint", new BufferAttribute(new Uint8Array(3 * corners.length), 3, true));
    this.faceOfTriangle = faces;
    this.faces = new Mesh(geometry, faceMaterial());
    this.primal.add(this.faces);
  }

  /** Normals of faces or of vertices; each made once. */
  #shade(smooth) {
    if (this.smooth === smooth) return;
    this.smooth = smooth;
    const { corners, faces } = this.surface.triangles;
    const normals = new Float32Array(3 * corners.length);
    corners.forEach((c, i) => {
      const f = faces[Math.floor(i / 3)];
      const ofVertex = smooth && c < this.surface.vertexCount;
      const [from, at] = ofVertex ? [this.surface.vertexNormals, c] : [this.surface.faceNormals, f];
      normals.set(from.subarray(3 * at, 3 * at + 3), 3 * i);
    });
    this.faces.geometry.setAttribute("normal", new BufferAttribute(normals, 3));
  }

  /** Colours by a field, or by index. */
  #tint(field) {
    const colours = this.#faceColours(field);
    const tint = this.faces.geometry.getAttribute("tint");
    this.faceOfTriangle.forEach((f, t) => {
      for (let i = 0; i < 3; i++) tint.array.set(colours[f], 9 * t + 3 * i);
    });
    tint.needsUpdate = true;
    if (this.liftedFaces) {
      const lifted = this.liftedFaces.geometry.getAttribute("tint");
      for (let i = 0; i < lifted.count; i++) lifted.array.set(theme().face, 3 * i);
      lifted.needsUpdate = true;
    }
  }

  #faceColours(field) {
    if (field) {
      const range = field.high - field.low;
      return Array.from(this.mesh.fields[field.key], (v) => heat((v - field.low) / range).map(Math.round));
    }
    const colours = new Array(this.surface.faceCount).fill(theme().face);
    const irregular = this.mesh.irregularFaces;
    for (let i = 0; i < irregular.length; i += 2) colours[irregular[i]] = ofIndex(irregular[i + 1]);
    return colours;
  }

  #edges() {
    const { edges } = this.surface;
    const positions = new Float32Array((edges.length / 4) * 6);
    for (let e = 0; e < edges.length; e += 4) {
      positions.set(this.surface.point(edges[e]), (e / 4) * 6);
      positions.set(this.surface.point(edges[e + 1]), (e / 4) * 6 + 3);
    }
    this.primal.add(this.#thinLines(positions));
  }

  #thinLines(positions) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(positions, 3));
    const material = new LineBasicMaterial({ transparent: true });
    this.lineMaterials.push({ material, role: "edge" });
    return new LineSegments(geometry, material);
  }

  #strongLines() {
    for (const [pairs, role] of [[this.mesh.sharpEdges, "sharp"], [this.mesh.boundaryEdges, "boundary"]]) {
      if (pairs.length === 0) continue;
      const positions = new Float32Array(3 * pairs.length);
      pairs.forEach((v, i) => positions.set(this.surface.point(v), 3 * i));
      const material = new LineMaterial({
        linewidth: 2.5, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -6,
      });
      this.lineMaterials.push({ material, role });
      const lines = new LineSegments2(new LineSegmentsGeometry().setPositions(positions), material);
      // In both domains: a feature is the same line in each.
      this.group.add(lines);
    }
  }

  *#vertexMarks() {
    const { tJunctions, irregularVertices } = this.mesh;
    for (let i = 0; i < tJunctions.length; i += 2) {
      yield { place: this.surface.point(tJunctions[i]), colour: T_JUNCTION, shape: 2, grow: 1.7 };
    }
    for (let i = 0; i < irregularVertices.length; i += 2) {
      yield this.#discOf(this.surface.point(irregularVertices[i]), irregularVertices[i + 1], 0);
    }
  }

  *#faceMarks() {
    const { irregularFaces } = this.mesh;
    for (let i = 0; i < irregularFaces.length; i += 2) {
      yield this.#discOf(this.surface.centre(irregularFaces[i]), irregularFaces[i + 1], 1);
    }
  }

  #discOf(place, index, shape) {
    return { place, colour: ofIndex(index), shape, grow: Math.abs(index) > 1 ? 1.35 : 1 };
  }

  #marks(marks) {
    const geometry = new BufferGeometry();
    const fill = (count, size, of) => {
      const array = new Float32Array(count * size);
      marks.forEach((mark, i) => array.set(of(mark), i * size));
      return new BufferAttribute(array, size);
    };
    geometry.setAttribute("position", fill(marks.length, 3, (m) => m.place));
    geometry.setAttribute("tint", fill(marks.length, 3, (m) => m.colour.map((c) => c / 255)));
    geometry.setAttribute("shape", fill(marks.length, 1, (m) => [m.shape]));
    geometry.setAttribute("grow", fill(marks.length, 1, (m) => [m.grow]));
    const material = markMaterial();
    material.uniforms.size.value = 0.55 * this.surface.meanEdge;
    return new Points(geometry, material);
  }

  /** The √CC mesh: a quad for each edge; vertices are discs, faces have become diamonds. */
  #lift() {
    const { positions, segments } = this.surface.lifted();
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(positions, 3));
    geometry.setAttribute("tint", new BufferAttribute(new Uint8Array(positions.length), 3, true));
    geometry.computeVertexNormals();
    this.lifted = new Group();
    this.liftedFaces = new Mesh(geometry, faceMaterial());
    const marks = this.#marks([...this.#vertexMarks(), ...this.#faceMarks()]);
    marks.material.uniforms.size.value *= 0.8;
    this.lifted.add(this.liftedFaces, this.#thinLines(segments), marks);
    this.group.add(this.lifted);
  }
}
