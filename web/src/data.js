// The data of the report: JSON, with long arrays as base64 of little-endian binary.

function bytes(text) {
  const binary = atob(text);
  const array = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) array[i] = binary.charCodeAt(i);
  return array.buffer;
}

const floats = (text) => new Float32Array(bytes(text));
const ints = (text) => new Int32Array(bytes(text));

/** Reads and unpacks everything. */
export function readData() {
  const script = document.getElementById("data");
  const data = JSON.parse(script.textContent);
  // The text is large and is not needed any more.
  script.remove();
  data.meshes = data.meshes.map(unpack);
  return data;
}

function unpack(mesh) {
  const pairs = (text) => ints(text);
  return {
    ...mesh,
    positions: floats(mesh.positions),
    corners: ints(mesh.corners),
    offsets: ints(mesh.offsets),
    vertexIds: mesh.vertex_ids && ints(mesh.vertex_ids),
    faceIds: mesh.face_ids && ints(mesh.face_ids),
    fields: Object.fromEntries(
      Object.entries(mesh.fields).map(([key, text]) => [key, floats(text)]),
    ),
    irregularVertices: pairs(mesh.irregular_vertices),
    irregularFaces: pairs(mesh.irregular_faces),
    tJunctions: pairs(mesh.t_junctions),
    sharpEdges: pairs(mesh.sharp_edges),
    boundaryEdges: pairs(mesh.boundary_edges),
  };
}
