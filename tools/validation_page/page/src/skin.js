// Linear blend skinning with any number of influences, as the shader of surface.js does. No DOM.
import { NONE } from './decode.js';
import { multiply } from './pose.js';

/** model_from_bind of all slots of a model. */
export function palette(model, modelFromBone) {
  const matrices = new Float32Array(model.slot_bones.length * 12);
  for (let slot = 0; slot < model.slot_bones.length; ++slot) {
    const bone = model.slot_source_bones[slot];
    if (bone === NONE)
      matrices.set(model.slot_matrices.subarray(slot * 12, slot * 12 + 12), slot * 12);
    else multiply(modelFromBone, bone * 12, model.slot_matrices, slot * 12, matrices, slot * 12);
  }
  return matrices;
}

const blend = new Float64Array(12);

/** Blends the matrices of a vertex; the identity if it has no weight. */
function blendMatrices(model, matrices, vertex) {
  blend.fill(0);
  let total = 0;
  for (let i = model.firstInfluence[vertex]; i < model.firstInfluence[vertex + 1]; ++i) {
    const weight = model.influence_weights[i] / 65535;
    const at = model.influence_slots[i] * 12;
    total += weight;
    for (let k = 0; k < 12; ++k) blend[k] += weight * matrices[at + k];
  }
  if (total === 0) blend[0] = blend[4] = blend[8] = 1;
}

function transform(source, vertex, w, out, outAt) {
  const [x, y, z] = [source[vertex * 3], source[vertex * 3 + 1], source[vertex * 3 + 2]];
  for (let row = 0; row < 3; ++row)
    out[outAt + row] = blend[row] * x + blend[3 + row] * y + blend[6 + row] * z + blend[9 + row] * w;
}

/** Posed positions of all vertices. */
export function posePositions(model, matrices) {
  const out = new Float32Array(model.positions.length);
  for (let v = 0; v < model.vertexCount; ++v) {
    blendMatrices(model, matrices, v);
    transform(model.positions, v, 1, out, v * 3);
  }
  return out;
}

/** Posed position and unit normal of one vertex. */
export function poseVertex(model, matrices, vertex) {
  const position = [0, 0, 0], normal = [0, 0, 0];
  blendMatrices(model, matrices, vertex);
  transform(model.positions, vertex, 1, position, 0);
  transform(model.smoothNormals, vertex, 0, normal, 0);
  const length = Math.hypot(...normal) || 1;
  return { position, normal: normal.map((x) => x / length) };
}
