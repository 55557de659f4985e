// Clips to transforms of bones. Matrices are 3 x 4, column by column, twelve numbers each. No DOM.
import { NONE } from './decode.js';

const PARTS = { translation: [0, 3], rotation: [3, 4], scale: [7, 3] };

/** Ten numbers per bone (translation, rotation, scale): a clip at a time, linear between samples. */
export function sampleClip(data, clip, time) {
  const parts = data.skeleton.rest.slice();
  if (!clip) return parts;
  const last = clip.samples - 1;
  const at = clip.duration > 0 ? Math.min(Math.max(time / clip.duration, 0), 1) * last : 0;
  const sample = Math.min(Math.floor(at), Math.max(last - 1, 0));
  const t = at - sample;
  for (const { bone, part, values } of clip.tracks) {
    const [first, width] = PARTS[part];
    const out = bone * 10 + first;
    const [a, b] = [sample * width, Math.min(sample + 1, last) * width];
    let sign = 1;
    if (part === 'rotation') {
      let dot = 0;
      for (let k = 0; k < 4; ++k) dot += values[a + k] * values[b + k];
      sign = dot < 0 ? -1 : 1;
    }
    for (let k = 0; k < width; ++k)
      parts[out + k] = (1 - t) * values[a + k] + t * sign * values[b + k];
    if (part === 'rotation') normalise(parts, out);
  }
  return parts;
}

function normalise(parts, at) {
  const length = Math.hypot(parts[at], parts[at + 1], parts[at + 2], parts[at + 3]) || 1;
  for (let k = 0; k < 4; ++k) parts[at + k] /= length;
}

/** model_from_bone of all bones. */
export function modelFromBone(data, parts) {
  const { parents } = data.skeleton;
  const matrices = new Float64Array(parents.length * 12);
  const local = new Float64Array(12);
  for (let bone = 0; bone < parents.length; ++bone) {
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
