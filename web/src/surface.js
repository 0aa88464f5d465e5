// Triangles, edges and normals of a polygon mesh, and of its √CC mesh.

/** Everything that drawing and picking need to know about a mesh. */
export class Surface {
  constructor(mesh) {
    this.mesh = mesh;
    this.faceCount = mesh.offsets.length - 1;
    this.vertexCount = mesh.positions.length / 3;
    this.centres = this.#centres();
    this.edges = this.#edges();
    this.faceNormals = this.#faceNormals();
    this.vertexNormals = this.#vertexNormals();
    this.triangles = this.#triangles();
    this.meanEdge = this.#meanEdge();
  }

  point(v) {
    return this.mesh.positions.subarray(3 * v, 3 * v + 3);
  }

  face(f) {
    return this.mesh.corners.subarray(this.mesh.offsets[f], this.mesh.offsets[f + 1]);
  }

  centre(f) {
    return this.centres.subarray(3 * f, 3 * f + 3);
  }

  #centres() {
    const centres = new Float32Array(3 * this.faceCount);
    for (let f = 0; f < this.faceCount; f++) {
      const face = this.face(f);
      for (const v of face) {
        for (let i = 0; i < 3; i++) centres[3 * f + i] += this.mesh.positions[3 * v + i] / face.length;
      }
    }
    return centres;
  }

  /** Ends and the one or two faces of each edge: a, b, f, g (−1 if there is none), in rows of 4. */
  #edges() {
    const known = new Map();
    const rows = [];
    for (let f = 0; f < this.faceCount; f++) {
      const face = this.face(f);
      for (let i = 0; i < face.length; i++) {
        const [a, b] = [face[i], face[(i + 1) % face.length]];
        const key = a < b ? a * this.vertexCount + b : b * this.vertexCount + a;
        const row = known.get(key);
        if (row === undefined) {
          known.set(key, rows.length);
          rows.push(a, b, f, -1);
        } else if (rows[row + 3] < 0) {
          rows[row + 3] = f;
        }
      }
    }
    return Int32Array.from(rows);
  }

  /** Newell's area vectors, normalised. */
  #faceNormals() {
    const normals = new Float32Array(3 * this.faceCount);
    for (let f = 0; f < this.faceCount; f++) {
      const face = this.face(f);
      const n = [0, 0, 0];
      for (let i = 0; i < face.length; i++) {
        const p = this.point(face[i]);
        const q = this.point(face[(i + 1) % face.length]);
        n[0] += (p[1] - q[1]) * (p[2] + q[2]);
        n[1] += (p[2] - q[2]) * (p[0] + q[0]);
        n[2] += (p[0] - q[0]) * (p[1] + q[1]);
      }
      normals.set(normalised(n), 3 * f);
    }
    return normals;
  }

  #vertexNormals() {
    const normals = new Float32Array(3 * this.vertexCount);
    for (let f = 0; f < this.faceCount; f++) {
      for (const v of this.face(f)) {
        for (let i = 0; i < 3; i++) normals[3 * v + i] += this.faceNormals[3 * f + i];
      }
    }
    for (let v = 0; v < this.vertexCount; v++) {
      normals.set(normalised(normals.subarray(3 * v, 3 * v + 3)), 3 * v);
    }
    return normals;
  }

  /** Quads are cut by the shorter diagonal, larger faces fan about their centre. A corner below
   * `vertexCount` is a vertex, above it the centre of a face. Face of each triangle beside them. */
  #triangles() {
    const corners = [];
    const faces = [];
    for (let f = 0; f < this.faceCount; f++) {
      const face = this.face(f);
      if (face.length === 3) corners.push(...face);
      else if (face.length === 4) corners.push(...this.#cutQuad(face));
      else {
        for (let i = 0; i < face.length; i++) {
          corners.push(face[i], face[(i + 1) % face.length], this.vertexCount + f);
        }
      }
      while (3 * faces.length < corners.length) faces.push(f);
    }
    return { corners: Uint32Array.from(corners), faces: Uint32Array.from(faces) };
  }

  #cutQuad([a, b, c, d]) {
    const short = distance(this.point(a), this.point(c)) <= distance(this.point(b), this.point(d));
    return short ? [a, b, c, a, c, d] : [a, b, d, b, c, d];
  }

  /** The place of a corner of a triangle. */
  corner(c) {
    return c < this.vertexCount ? this.point(c) : this.centre(c - this.vertexCount);
  }

  #meanEdge() {
    let sum = 0;
    for (let e = 0; e < this.edges.length; e += 4) {
      sum += distance(this.point(this.edges[e]), this.point(this.edges[e + 1]));
    }
    return sum / Math.max(1, this.edges.length / 4);
  }

  /** Quads p, d, p', d' of the √CC mesh as triangles, and its edges p–d as segments. */
  lifted() {
    const positions = [];
    const segments = [];
    for (let e = 0; e < this.edges.length; e += 4) {
      const [a, b] = [this.point(this.edges[e]), this.point(this.edges[e + 1])];
      for (const f of [this.edges[e + 2], this.edges[e + 3]].filter((f) => f >= 0)) {
        const d = this.centre(f);
        // The first face of an edge has it from a to b, the other one from b to a.
        positions.push(...(f === this.edges[e + 2] ? [...a, ...b] : [...b, ...a]), ...d);
      }
    }
    for (let f = 0; f < this.faceCount; f++) {
      for (const v of this.face(f)) segments.push(...this.point(v), ...this.centre(f));
    }
    return { positions: Float32Array.from(positions), segments: Float32Array.from(segments) };
  }

  /** The face that a ray hits first, and where; null if it hits none. */
  hit(origin, direction) {
    const { corners, faces } = this.triangles;
    let best = null;
    for (let t = 0; t < faces.length; t++) {
      const along = crossing(
        origin, direction,
        this.corner(corners[3 * t]), this.corner(corners[3 * t + 1]), this.corner(corners[3 * t + 2]),
      );
      if (along !== null && (best === null || along < best.along)) best = { along, face: faces[t] };
    }
    if (best === null) return null;
    return { face: best.face, point: origin.map((o, i) => o + best.along * direction[i]) };
  }

  /** The vertex nearest to a point. */
  nearestVertex(point) {
    let [best, least] = [0, Infinity];
    for (let v = 0; v < this.vertexCount; v++) {
      const d = distance(this.point(v), point);
      if (d < least) [best, least] = [v, d];
    }
    return best;
  }
}

export function distance(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

function normalised(n) {
  const length = Math.hypot(n[0], n[1], n[2]);
  return length > 0 ? [n[0] / length, n[1] / length, n[2] / length] : [0, 0, 0];
}

/** How far along a ray it crosses a triangle (Möller & Trumbore 1997); null if it does not. */
function crossing(origin, direction, a, b, c) {
  const [e, g] = [sub(b, a), sub(c, a)];
  const p = cross(direction, g);
  const det = dot(e, p);
  if (det === 0) return null;
  const s = sub(origin, a);
  const u = dot(s, p) / det;
  if (!(u >= 0 && u <= 1)) return null;
  const q = cross(s, e);
  const v = dot(direction, q) / det;
  if (!(v >= 0 && u + v <= 1)) return null;
  const along = dot(g, q) / det;
  return along > 0 ? along : null;
}

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
