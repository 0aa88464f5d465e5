// What there is to say about a vertex or a face, and the tour of irregular elements.
import { shown, signed } from "./dom.js";
import { distance } from "./surface.js";

/** The element at a hit: a corner if it is near, else the face. */
export function elementAt(surface, hit) {
  const corners = Array.from(surface.face(hit.face));
  const nearest = corners.reduce((best, v) => {
    const d = distance(surface.point(v), hit.point);
    return d < best.d ? { v, d } : best;
  }, { v: -1, d: Infinity });
  const near = nearest.d < 0.3 * distance(surface.point(nearest.v), surface.centre(hit.face));
  return near ? { kind: "vertex", id: nearest.v } : { kind: "face", id: hit.face };
}

/** Heading and facts about an element. */
export function describe(surface, element, fields) {
  const { mesh } = surface;
  const ids = element.kind === "vertex" ? mesh.vertexIds : mesh.faceIds;
  const number = (ids ? ids[element.id] : element.id) + 1;
  const facts = element.kind === "vertex"
    ? vertexFacts(surface, element.id)
    : faceFacts(surface, element.id, fields);
  const title = `${element.kind === "vertex" ? "Vertex" : "Face"} ${number}`;
  return { title, facts };
}

function vertexFacts(surface, v) {
  const { mesh } = surface;
  const listed = lookUp(mesh.irregularVertices, v);
  const t = lookUp(mesh.tJunctions, v);
  const valence = edgesAt(surface, v);
  const boundary = mesh.boundaryEdges.includes(v);
  const index = boundary ? "on the boundary" : signed(listed ?? 0);
  const facts = [["valence", shown(valence)], ["index", index]];
  if (t !== undefined) {
    facts.push(["T-junction", `hangs in face ${(mesh.faceIds ? mesh.faceIds[t] : t) + 1}`]);
  }
  if (mesh.sharpEdges.includes(v)) facts.push(["sharp feature", "yes"]);
  return facts;
}

function faceFacts(surface, f, fields) {
  const { mesh } = surface;
  const index = lookUp(mesh.irregularFaces, f) ?? 0;
  // The degree is that of the file, also where a corner is not shown.
  const facts = [["degree", shown(4 - index)], ["index", signed(index)]];
  for (const field of fields) {
    const value = mesh.fields[field.key]?.[f];
    if (value !== undefined) {
      facts.push([field.label, Number.isNaN(value) ? "only of quads" : `${shown(value)} ${field.unit}`]);
    }
  }
  return facts;
}

/** The second of the pair that begins with `id`. */
function lookUp(pairs, id) {
  for (let i = 0; i < pairs.length; i += 2) if (pairs[i] === id) return pairs[i + 1];
  return undefined;
}

function edgesAt(surface, v) {
  let count = 0;
  for (let e = 0; e < surface.edges.length; e += 4) {
    if (surface.edges[e] === v || surface.edges[e + 1] === v) count += 1;
  }
  return count;
}

/** Where an element is, which way it faces, and the points that mark it. */
export function placeOf(surface, { kind, id }) {
  const slice = (array) => Array.from(array.subarray(3 * id, 3 * id + 3));
  if (kind === "vertex") {
    const place = Array.from(surface.point(id));
    return { place, normal: slice(surface.vertexNormals), outline: [place] };
  }
  const outline = Array.from(surface.face(id), (v) => Array.from(surface.point(v)));
  return { place: Array.from(surface.centre(id)), normal: slice(surface.faceNormals), outline };
}

/** All irregular elements, those that are near each other one after the other. */
export function tour(surface) {
  const { irregularVertices, irregularFaces, positions } = surface.mesh;
  const stops = [];
  const add = (pairs, kind, place) => {
    for (let i = 0; i < pairs.length; i += 2) stops.push({ kind, id: pairs[i], place: place(pairs[i]) });
  };
  add(irregularVertices, "vertex", (v) => surface.point(v));
  add(irregularFaces, "face", (f) => surface.centre(f));
  const low = [Infinity, Infinity, Infinity];
  let size = 0;
  for (let i = 0; i < positions.length; i++) low[i % 3] = Math.min(low[i % 3], positions[i]);
  for (let i = 0; i < positions.length; i++) size = Math.max(size, positions[i] - low[i % 3]);
  for (const stop of stops) stop.key = morton(stop.place, low, size || 1);
  return stops.sort((a, b) => a.key - b.key || a.id - b.id);
}

/** Place on a curve that visits near places one after the other (Morton 1966). */
function morton(place, low, size) {
  const cells = [0, 1, 2].map((i) => Math.min(1023, Math.floor(((place[i] - low[i]) / size) * 1024)));
  let key = 0;
  for (let bit = 9; bit >= 0; bit--) for (const c of cells) key = 2 * key + ((c >> bit) & 1);
  return key;
}
