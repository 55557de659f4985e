// Morph targets and linear blend skinning with any number of influences, in double precision: what
// the shader of skinned_geometry.js does in single. No DOM.
import { NONE } from './decode.js';
import { multiply } from './pose.js';

/**
 * A model in a pose: {palette, morphWeights}, model_from_bind of all its slots and the weights of
 * its morph targets. A model with other morph targets than the pose keeps them as at rest.
 */
export function poseOf(model, modelFromBone, morphWeights) {
  const rest = model.morph_weights;
  return { palette: palette(model, modelFromBone),
    morphWeights: morphWeights?.length === rest.length ? morphWeights : rest };
}

function palette(model, modelFromBone) {
  const matrices = new Float64Array(model.slot_bones.length * 12);
  for (let slot = 0; slot < model.slot_bones.length; ++slot) {
    const bone = model.slot_source_bones[slot];
    if (bone === NONE)
      matrices.set(model.slot_matrices.subarray(slot * 12, slot * 12 + 12), slot * 12);
    else multiply(modelFromBone, bone * 12, model.slot_matrices, slot * 12, matrices, slot * 12);
  }
  return matrices;
}

/** Positions before skinning, morph targets applied; not to be written to. */
export function morphedPositions(model, morphWeights) {
  if (!model.morphs.length) return model.positions;
  const out = Float64Array.from(model.positions);
  for (const { weight, vertices, deltas } of model.morphs)
    if (morphWeights[weight] !== 0)
      for (let i = 0; i < vertices.length; ++i)
        for (let k = 0; k < 3; ++k)
          out[vertices[i] * 3 + k] += morphWeights[weight] * deltas[i * 3 + k];
  return out;
}

const blend = new Float64Array(12);

/** Blends the matrices of a vertex; the identity if it has no weight. */
function blendMatrices(model, matrices, vertex) {
  blend.fill(0);
  let total = 0;
  for (let i = model.firstInfluence[vertex]; i < model.firstInfluence[vertex + 1]; ++i) {
    const weight = model.influence_weights[i];
    const at = model.influence_slots[i] * 12;
    total += weight;
    for (let k = 0; k < 12; ++k) blend[k] += weight * matrices[at + k];
  }
  if (total === 0) blend[0] = blend[4] = blend[8] = 1;
}

function transform(source, at, w, out, outAt) {
  const [x, y, z] = [source[at], source[at + 1], source[at + 2]];
  for (let row = 0; row < 3; ++row)
    out[outAt + row] = blend[row] * x + blend[3 + row] * y + blend[6 + row] * z + blend[9 + row] * w;
}

/** Posed positions of all vertices. @param pose  of poseOf() */
export function posePositions(model, pose) {
  const morphed = pose.morphed ??= morphedPositions(model, pose.morphWeights);
  const out = new Float64Array(morphed.length);
  for (let v = 0; v < model.vertexCount; ++v) {
    blendMatrices(model, pose.palette, v);
    transform(morphed, v * 3, 1, out, v * 3);
  }
  return out;
}

/** Posed positions of some vertices, one after the other. */
export function poseVertices(model, pose, vertices) {
  const morphed = pose.morphed ??= morphedPositions(model, pose.morphWeights);
  const out = new Float64Array(vertices.length * 3);
  vertices.forEach((vertex, i) => {
    blendMatrices(model, pose.palette, vertex);
    transform(morphed, vertex * 3, 1, out, i * 3);
  });
  return out;
}

/** Unit normal of one vertex; morph targets do not turn it. */
export function poseNormal(model, pose, vertex) {
  const normal = [0, 0, 0];
  blendMatrices(model, pose.palette, vertex);
  transform(model.smoothNormals, vertex * 3, 0, normal, 0);
  const length = Math.hypot(...normal) || 1;
  return normal.map((x) => x / length);
}
