// A model's geometry for three.js, skinned in the vertex shader with any number of influences, which
// stand in a texture.
import {
  BufferAttribute, BufferGeometry, DataTexture, FloatType, RGBAFormat, RGFormat,
} from 'three';
import { morphedPositions } from './skin.js';

const INFLUENCES_PER_ROW = 2048;
const SLOTS_PER_ROW = 256;

/** Declarations for a vertex shader, and skin(): the rows of a vertex' blended matrix. */
export const SKINNING = `
in uvec2 influences;  // first, count
uniform sampler2D influenceTexture;  // slot, weight
uniform sampler2D paletteTexture;    // three rows per slot

void skin(out vec4 x, out vec4 y, out vec4 z) {
  x = y = z = vec4(0.0);
  float total = 0.0;
  for (uint i = influences.x; i < influences.x + influences.y; ++i) {
    ivec2 place = ivec2(int(i) % ${INFLUENCES_PER_ROW}, int(i) / ${INFLUENCES_PER_ROW});
    vec2 share = texelFetch(influenceTexture, place, 0).rg;
    int slot = int(share.x);
    ivec2 row = ivec2(slot % ${SLOTS_PER_ROW} * 3, slot / ${SLOTS_PER_ROW});
    x += share.y * texelFetch(paletteTexture, row, 0);
    y += share.y * texelFetch(paletteTexture, row + ivec2(1, 0), 0);
    z += share.y * texelFetch(paletteTexture, row + ivec2(2, 0), 0);
    total += share.y;
  }
  if (total == 0.0) {
    x = vec4(1.0, 0.0, 0.0, 0.0);
    y = vec4(0.0, 1.0, 0.0, 0.0);
    z = vec4(0.0, 0.0, 1.0, 0.0);
  }
}`;

function floatTexture(values, width, perTexel, format) {
  const height = Math.max(1, Math.ceil(values.length / perTexel / width));
  const padded = new Float32Array(width * height * perTexel);
  padded.set(values);
  const texture = new DataTexture(padded, width, height, format, FloatType);
  texture.needsUpdate = true;
  return texture;
}

function influenceTexture(model) {
  const pairs = new Float32Array(model.influence_slots.length * 2);
  for (let i = 0; i < model.influence_slots.length; ++i)
    pairs.set([model.influence_slots[i], model.influence_weights[i]], i * 2);
  return floatTexture(pairs, INFLUENCES_PER_ROW, 2, RGFormat);
}

function geometryOf(model) {
  const influences = new Uint32Array(model.vertexCount * 2);
  for (let v = 0; v < model.vertexCount; ++v)
    influences.set([model.firstInfluence[v], model.influence_counts[v]], v * 2);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(model.positions.slice(), 3));
  geometry.setAttribute('normal', new BufferAttribute(model.smoothNormals, 3));
  geometry.setAttribute('influences', new BufferAttribute(influences, 2));
  geometry.setIndex(new BufferAttribute(model.indices, 1));
  return geometry;
}

export class SkinnedGeometry {
  constructor(model) {
    this.model = model;
    this.geometry = geometryOf(model);
    const rows = new Float32Array(model.slot_bones.length * 12);
    this.paletteTexture = floatTexture(rows, SLOTS_PER_ROW * 3, 4, RGBAFormat);
    /** For the uniforms of a material. */
    this.uniforms = {
      influenceTexture: { value: influenceTexture(model) },
      paletteTexture: { value: this.paletteTexture },
    };
    this.morphWeights = null;
  }

  /** @param pose  of skin.js: poseOf() */
  setPose({ palette, morphWeights }) {
    const rows = this.paletteTexture.image.data;
    for (let slot = 0; slot * 12 < palette.length; ++slot)
      for (let row = 0; row < 3; ++row)
        for (let column = 0; column < 4; ++column)
          rows[slot * 12 + row * 4 + column] = palette[slot * 12 + column * 3 + row];
    this.paletteTexture.needsUpdate = true;
    this.setMorphs(morphWeights);
  }

  setMorphs(morphWeights) {
    const { model } = this;
    if (!model.morphs.length || this.morphWeights?.every((x, i) => x === morphWeights[i])) return;
    this.morphWeights = Float64Array.from(morphWeights);
    const attribute = this.geometry.getAttribute('position');
    attribute.array.set(morphedPositions(model, morphWeights));
    attribute.needsUpdate = true;
  }
}
