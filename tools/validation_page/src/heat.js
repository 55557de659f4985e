// What the heat map shows: an array of the target or a bone's weights on both models.
import { Scale } from './colours.js';
import { influencesOf, NONE } from '../../page_parts/src/decode.js';
import { niceTop } from '../../page_parts/src/format.js';

/** The weights that a bone has in each vertex of a model. */
function weightsOf(model, bone) {
  const values = new Float32Array(model.vertexCount);
  for (let v = 0; v < model.vertexCount; ++v)
    for (let i = model.firstInfluence[v]; i < model.firstInfluence[v + 1]; ++i)
      if (model.slot_bones[model.influence_slots[i]] === bone)
        values[v] += model.influence_weights[i];
  return values;
}

/** {name, unit, signed, threshold, target, source}: values of both models, null where it has none. */
export function shownArray(array) {
  return { ...array, target: array.values, source: null, bone: NONE };
}

export function shownBone(data, bone) {
  const ofSource = data.target.source_bones[bone];
  return {
    name: `Weight of ${data.target.bones[bone]}`, unit: '', signed: false, threshold: null,
    target: weightsOf(data.target, bone),
    source: ofSource === NONE ? null : weightsOf(data.source, ofSource),
    bone: ofSource, isWeight: true,
  };
}

/** Bones of the target that weigh anything. */
export function weighingBones(model) {
  const weighs = new Uint8Array(model.bones.length);
  for (let i = 0; i < model.influence_slots.length; ++i)
    if (model.influence_weights[i] > 0) weighs[model.slot_bones[model.influence_slots[i]]] = 1;
  return model.bones.map((_, bone) => bone).filter((bone) => weighs[bone]);
}

/** The largest size of a value, and one that shows most: outliers are beyond the scale. */
export function topsOf(shown) {
  if (shown.isWeight) return { most: 1, wanted: 1 };
  const sizes = Array.from(shown.target, Math.abs)
    .filter((size) => size > 0 && Number.isFinite(size)).sort((a, b) => a - b);
  if (!sizes.length) return { most: shown.threshold || 1, wanted: shown.threshold || 1 };
  const most = sizes.at(-1);
  const usual = sizes[Math.floor(0.99 * (sizes.length - 1))];
  return { most: niceTop(most), wanted: niceTop(most <= 2.5 * usual ? most : usual) };
}

export function scaleOf(shown, top, log) {
  return new Scale({ top, log, signed: shown.signed });
}

/** Up to `count` vertices with the largest values, no two closer than `distance` at bind. */
export function worstVertices(model, shown, count, distance) {
  const { positions } = model;
  const order = Array.from(shown.target.keys())
    .filter((v) => Math.abs(shown.target[v]) > 0)
    .sort((a, b) => Math.abs(shown.target[b]) - Math.abs(shown.target[a]) || a - b);
  const chosen = [];
  for (const v of order) {
    if (chosen.length === count) break;
    const isNear = (other) => Math.hypot(...[0, 1, 2].map(
      (k) => positions[v * 3 + k] - positions[other * 3 + k])) < distance;
    if (!chosen.some(isNear)) chosen.push(v);
  }
  return chosen;
}

/** "Trunk2 0.71 · Left1 0.29" */
export function influencesText(model, vertex, most = 4) {
  const shares = influencesOf(model, vertex);
  const text = shares.slice(0, most)
    .map(({ bone, weight }) => `${model.bones[bone]} ${weight.toFixed(2)}`).join(' · ');
  return shares.length > most ? `${text} · ${shares.length - most} more` : text || 'no influence';
}
