// Poses of a log that is read, given to a player. No DOM.
import { modelFromBone, restPose } from '../../page_parts/src/pose.js';
import { clipIndex } from './log.js';

const PARTS = { translation: 0, rotation: 3, scale: 7 };

/** Rest with the given parts of bones. Throws a text for a bone that the model does not have. */
function posedBones(data, bones) {
  const { parts } = restPose(data);
  for (const [name, given] of Object.entries(bones)) {
    const bone = data.source.bones.indexOf(name);
    if (bone < 0) throw new Error(`The model has no bone named '${name}'.`);
    for (const [part, values] of Object.entries(given)) parts.set(values, bone * 10 + PARTS[part]);
  }
  return modelFromBone(data, parts);
}

/** From 3 x 4 matrices, row by row. */
function givenMatrices(data, matrices) {
  const bones = data.skeleton.parents.length;
  if (matrices.length !== bones)
    throw new Error(`The pose has ${matrices.length} matrices, the model ${bones} bones.`);
  return Float64Array.from(matrices.flatMap((rows) =>
    Array.from({ length: 12 }, (_, i) => rows[(i % 3) * 4 + Math.floor(i / 3)])));
}

/** Makes a player show a pose. @return what is wrong with it, or nothing. */
export function givePose(data, player, spec) {
  const named = data.poses.findIndex((pose) => pose.spec === spec);
  if (named >= 0) {
    player.setPose(named);
    return '';
  }
  if (spec.clip !== undefined) {
    const clip = clipIndex(data, spec);
    if (clip < 0) return `The model has no clip '${spec.clip}'.`;
    player.setClip(clip);
    player.seek(spec.time);
    return '';
  }
  try {
    const matrices = spec.bones ? posedBones(data, spec.bones) : givenMatrices(data, spec.matrices);
    player.poses[data.poses.length] = { name: 'Given pose', spec, matrices,
      morph_weights: spec.morph_weights };
  } catch (error) {
    return error.message;
  }
  player.setPose(data.poses.length);
  return '';
}
