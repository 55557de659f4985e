// Which bone a clicked place belongs to, and where on that bone it is. No DOM.
import { influencesOf, NONE } from '../../page_parts/src/decode.js';
import { add, distance, dot, unit } from './vectors.js';

/** The bone that moves a place most: {corners, shares} of a hit. */
export function boneOf(model, { corners, shares }) {
  const weights = new Map();
  corners.forEach((vertex, i) => {
    for (const { bone, weight } of influencesOf(model, vertex))
      weights.set(bone, (weights.get(bone) ?? 0) + shares[i] * weight);
  });
  return [...weights].reduce((best, entry) => (entry[1] > best[1] ? entry : best), [NONE, 0])[0];
}

/** Per bone, how many vertices it and those below it move most. Parents come before children. */
function branchSizes(model, parents) {
  const sizes = new Uint32Array(parents.length);
  for (let v = 0; v < model.vertexCount; ++v) {
    const bone = influencesOf(model, v)[0]?.bone ?? NONE;
    if (bone !== NONE) sizes[bone] += 1;
  }
  for (let bone = parents.length; bone-- > 0;)
    if (parents[bone] !== NONE) sizes[parents[bone]] += sizes[bone];
  return sizes;
}

export class Limbs {
  /** @param model  of the page's data, whose bones are those of `parents` */
  constructor(model, parents) {
    Object.assign(this, { model, parents, sizes: branchSizes(model, parents) });
  }

  /** Whether a bone is another one or below it. */
  isBelow(bone, ancestor) {
    let at = bone;
    while (at !== NONE && at !== ancestor) at = this.parents[at];
    return at === ancestor;
  }

  /** The joint of a bone and the one that it leads to: the child with most surface; or null. */
  segment(bone, bones) {
    const joint = (of) => Array.from(bones.subarray(of * 12 + 9, of * 12 + 12));
    const from = joint(bone);
    let best = null;
    this.parents.forEach((parent, child) => {
      if (parent !== bone || this.sizes[child] === 0) return;
      const to = joint(child);
      if (distance(from, to) < 1e-6 || (best && this.sizes[child] <= best.size)) return;
      best = { from, to, size: this.sizes[child] };
    });
    return best;
  }

  /** {bone, at} of a hit; `at` is absent where the bone leads nowhere. */
  placeOf(hit, bones) {
    const bone = boneOf(this.model, hit);
    if (bone === NONE) return null;
    const name = this.model.bones[bone];
    const segment = this.segment(bone, bones);
    if (!segment) return { bone: name, index: bone };
    const along = add(segment.to, segment.from, -1);
    const share = dot(add(hit.position, segment.from, -1), along) / dot(along, along);
    return { bone: name, index: bone, at: Number(Math.min(Math.max(share, 0), 1).toFixed(3)),
      direction: unit(along) };
  }
}

/** A place of the surface as an incision names it: the mesh, the triangle in it, barycentrics. */
export function surfacePlace(model, { triangle, shares }) {
  const first = model.indices[3 * triangle];
  const mesh = model.meshes.findLastIndex(({ first_vertex: begin }) => begin <= first);
  return { mesh, triangle: triangle - firstTriangle(model, mesh), barycentrics: shares };
}

/** The triangles of meshes follow each other, as their vertices do. */
function firstTriangle(model, mesh) {
  const { first_vertex: begin } = model.meshes[mesh];
  let [low, high] = [0, model.indices.length / 3];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (model.indices[3 * middle] < begin) low = middle + 1;
    else high = middle;
  }
  return low;
}
