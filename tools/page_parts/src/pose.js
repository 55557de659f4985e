// Clips to transforms of bones, as skinning/sample_channel.cpp computes them. Matrices are 3 x 4,
// column by column, twelve numbers each. No DOM.
import { NONE } from './decode.js';

const FIRST_OF_PART = { translation: 0, rotation: 3, scale: 7 };

/** {parts, morphWeights} at rest: ten numbers per bone (translation, rotation, scale). */
export function restPose({ skeleton }) {
  return { parts: Float64Array.from(skeleton.rest),
    morphWeights: Float64Array.from(skeleton.morph_weights) };
}

/** The same of a clip at a time, in seconds. */
export function sampleClip(data, clip, time) {
  const pose = restPose(data);
  for (const track of clip?.tracks ?? []) {
    const at = findKeys(track.times, time);
    if (track.part === 'morph_weights')
      for (let k = 0; k < track.width; ++k)
        pose.morphWeights[track.index + k] = interpolate(track, at, k);
    else sampleBone(track, at, pose.parts, track.index * 10 + FIRST_OF_PART[track.part]);
  }
  return pose;
}

/** The last key at or before a time, and the share of the way to the next one. */
function findKeys(times, time) {
  const last = times.length - 1;
  if (time <= times[0]) return { key: 0, share: 0, seconds: 0 };
  if (time >= times[last]) return { key: last, share: 0, seconds: 0 };
  let key = 0, after = last;
  while (after - key > 1) {
    const middle = (key + after) >> 1;
    if (times[middle] > time) after = middle;
    else key = middle;
  }
  const seconds = times[after] - times[key];
  return { key, share: (time - times[key]) / seconds, seconds };
}

/** One number of a value; linear rotations are interpolated by slerp instead. */
function interpolate({ interpolation, width, values }, { key, share: t, seconds }, component) {
  if (interpolation !== 'cubic_spline') {
    const from = values[key * width + component];
    if (interpolation === 'step' || t === 0) return from;
    return from + t * (values[(key + 1) * width + component] - from);
  }
  const value = (part) => values[(key * 3 + part) * width + component];
  if (t === 0) return value(1);
  return (2 * t ** 3 - 3 * t ** 2 + 1) * value(1) + seconds * (t ** 3 - 2 * t ** 2 + t) * value(2) +
    (3 * t ** 2 - 2 * t ** 3) * value(4) + seconds * (t ** 3 - t ** 2) * value(3);
}

function sampleBone(track, at, parts, first) {
  if (track.part !== 'rotation') {
    for (let k = 0; k < 3; ++k) parts[first + k] = interpolate(track, at, k);
    return;
  }
  if (track.interpolation === 'linear' && at.share > 0) slerp(track.values, at, parts, first);
  else for (let k = 0; k < 4; ++k) parts[first + k] = interpolate(track, at, k);
  normalise(parts, first);
}

/** Along the shorter arc. */
function slerp(values, { key, share }, out, first) {
  const from = Float64Array.from(values.subarray(key * 4, key * 4 + 4));
  const to = Float64Array.from(values.subarray(key * 4 + 4, key * 4 + 8));
  normalise(from, 0);
  normalise(to, 0);
  const cosine = from.reduce((sum, x, k) => sum + x * to[k], 0);
  let ofFrom = 1 - share, ofTo = share;
  if (Math.abs(cosine) < 1 - 1.2e-7) {  // the epsilon of the library's floats
    const angle = Math.acos(Math.abs(cosine));
    ofFrom = Math.sin((1 - share) * angle) / Math.sin(angle);
    ofTo = Math.sin(share * angle) / Math.sin(angle);
  }
  if (cosine < 0) ofTo = -ofTo;
  for (let k = 0; k < 4; ++k) out[first + k] = ofFrom * from[k] + ofTo * to[k];
}

/** A rotation without length becomes none. */
function normalise(parts, at) {
  const length = Math.hypot(parts[at], parts[at + 1], parts[at + 2], parts[at + 3]);
  if (length > 0) for (let k = 0; k < 4; ++k) parts[at + k] /= length;
  else parts.set([0, 0, 0, 1], at);
}

/** model_from_bone of all bones. */
export function modelFromBone(data, parts) {
  const { parents } = data.skeleton;
  const matrices = new Float64Array(parents.length * 12);
  const local = new Float64Array(12);
  for (let bone = 0; bone < parents.length; ++bone) {
    normalise(parts, bone * 10 + FIRST_OF_PART.rotation);
    setTransform(local, parts, bone * 10);
    if (parents[bone] === NONE) matrices.set(local, bone * 12);
    else multiply(matrices, parents[bone] * 12, local, 0, matrices, bone * 12);
  }
  return matrices;
}

function setTransform(out, parts, at) {
  const [tx, ty, tz, x, y, z, w, sx, sy, sz] = parts.subarray(at, at + 10);
  out.set([
    sx * (1 - 2 * (y * y + z * z)), sx * 2 * (x * y + z * w), sx * 2 * (x * z - y * w),
    sy * 2 * (x * y - z * w), sy * (1 - 2 * (x * x + z * z)), sy * 2 * (y * z + x * w),
    sz * 2 * (x * z + y * w), sz * 2 * (y * z - x * w), sz * (1 - 2 * (x * x + y * y)),
    tx, ty, tz,
  ]);
}

/** out = a * b, each at an offset; `out` is neither. */
export function multiply(a, aAt, b, bAt, out, outAt) {
  for (let column = 0; column < 4; ++column)
    for (let row = 0; row < 3; ++row) {
      let sum = column === 3 ? a[aAt + 9 + row] : 0;
      for (let k = 0; k < 3; ++k) sum += a[aAt + k * 3 + row] * b[bAt + column * 3 + k];
      out[outAt + column * 3 + row] = sum;
    }
}
