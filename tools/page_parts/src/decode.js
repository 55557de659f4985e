// The data of a page, as tools/page_parts/page_file.cpp writes it. No DOM: tests run it in node.

const TYPES = {
  f64: Float64Array, f32: Float32Array, u32: Uint32Array, u16: Uint16Array, i16: Int16Array, u8: Uint8Array,
};

/** "No such index", as in sunder/core/index.h. */
export const NONE = 0xffffffff;

/** The bytes of base64. */
export function bytesOf(text) {
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** The JSON of the data, with typed arrays in place of what refers to them. `target` may be null. */
export function decode(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const magic = String.fromCharCode(...bytes.subarray(0, 4));
  if (magic !== 'SNDP') throw new Error('This is not the data of a page.');
  const version = view.getUint32(4, true);
  if (version !== 2) throw new Error(`The data has version ${version}, expected 2.`);
  const length = view.getUint32(8, true);
  const payload = bytes.slice(12 + length).buffer;
  const text = new TextDecoder().decode(bytes.subarray(12, 12 + length));
  const data = JSON.parse(text, (key, value) => {
    const type = TYPES[value?.type];
    return type ? new type(payload, value.first, value.count) : value;
  });
  for (const model of [data.source, data.target]) if (model) prepare(model);
  return data;
}

/** Adds what follows from a model's arrays. */
function prepare(model) {
  const counts = model.influence_counts;
  model.vertexCount = counts.length;
  model.firstInfluence = new Uint32Array(counts.length + 1);
  for (let v = 0; v < counts.length; ++v)
    model.firstInfluence[v + 1] = model.firstInfluence[v] + counts[v];
  model.smoothNormals = model.normals.some((x) => x !== 0)
    ? Float32Array.from(model.normals, (x) => x / 32767)
    : smoothNormals(model.positions, model.indices);
}

/** Normals weighted by area; vertices at the same place share theirs. */
function smoothNormals(positions, indices) {
  const place = placeOfVertex(positions);
  const sums = new Float32Array(positions.length);
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [indices[i] * 3, indices[i + 1] * 3, indices[i + 2] * 3];
    const u = [0, 1, 2].map((k) => positions[b + k] - positions[a + k]);
    const v = [0, 1, 2].map((k) => positions[c + k] - positions[a + k]);
    const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    for (const corner of [a, b, c])
      for (let k = 0; k < 3; ++k) sums[place[corner / 3] * 3 + k] += cross[k];
  }
  const normals = new Float32Array(positions.length);
  for (let v = 0; v < place.length; ++v) {
    const at = place[v] * 3;
    const length = Math.hypot(sums[at], sums[at + 1], sums[at + 2]) || 1;
    for (let k = 0; k < 3; ++k) normals[v * 3 + k] = sums[at + k] / length;
  }
  return normals;
}

/** For each vertex the first vertex at its position. */
function placeOfVertex(positions) {
  const first = new Map();
  return Uint32Array.from({ length: positions.length / 3 }, (_, v) => {
    const key = `${positions[v * 3]} ${positions[v * 3 + 1]} ${positions[v * 3 + 2]}`;
    if (!first.has(key)) first.set(key, v);
    return first.get(key);
  });
}

/** The mesh of a vertex, and the vertex' number in it. */
export function vertexInMesh(model, vertex) {
  const mesh = model.meshes.findLast((candidate) => candidate.first_vertex <= vertex);
  return { mesh, number: vertex - mesh.first_vertex };
}

/** The bones that move a vertex and their weights, largest first. */
export function influencesOf(model, vertex) {
  const shares = [];
  for (let i = model.firstInfluence[vertex]; i < model.firstInfluence[vertex + 1]; ++i)
    shares.push({
      bone: model.slot_bones[model.influence_slots[i]],
      weight: model.influence_weights[i],
    });
  return shares.sort((a, b) => b.weight - a.weight);
}
