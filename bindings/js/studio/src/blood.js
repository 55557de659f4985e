// Blood beside the wounds of a character: what woundMask() tells of each mesh, laid over its materials.
import * as THREE from 'three';

const TEXELS = 512;
/** Where the last of the blood ends, as a share of the size. */
const REACH = 0.015;
const FRESH = new THREE.Color(0.26, 0.008, 0.009), CLOTTED = new THREE.Color(0.085, 0.003, 0.004);

const vector = ({ r, g, b }) => `vec3(${[r, g, b].map((value) => value.toFixed(4))})`;
const NOISE = `
uniform sampler2D woundNearness;
varying vec2 vWoundUv;
float bloodAt(vec2 cell) { return fract(sin(dot(cell, vec2(127.1, 311.7))) * 43758.5453); }
float bloodClouds(vec2 place) {
  vec2 low = floor(place), part = smoothstep(0.0, 1.0, fract(place));
  return mix(mix(bloodAt(low), bloodAt(low + vec2(1, 0)), part.x), mix(bloodAt(low + vec2(0, 1)), bloodAt(low + 1.0), part.x), part.y);
}`;
const COLOUR = `
  float nearness = texture2D(woundNearness, vWoundUv).r;
  if (nearness > 0.0) {
    float border = 0.7 * (0.6 * bloodClouds(110.0 * vWoundUv) + 0.4 * bloodClouds(300.0 * vWoundUv));
    float clots = bloodClouds(170.0 * vWoundUv);
    vec3 blood = mix(${vector(FRESH)}, ${vector(CLOTTED)}, 0.7 * clots * nearness);
    float cover = smoothstep(border, border + 0.25, nearness) * mix(0.5, 0.97, nearness);
    diffuseColor.rgb = mix(diffuseColor.rgb, blood, max(cover, smoothstep(0.9, 1.0, nearness)));
  }`;

/** Of the meshes with texture coordinates; of meshes that share a material, the first one alone. */
export class Blood {
  #instance;
  #reach;
  #layers = [];

  /** @param object  the SunderObject of the instance @param size  of the character, metres */
  constructor(instance, object, size) {
    this.#instance = instance;
    this.#reach = REACH * size;
    const taken = new Set();
    object.children.forEach(({ geometry, material }, mesh) => {
      const materials = [...new Set([material].flat())];
      if (!geometry.attributes.uv || materials.some((one) => taken.has(one))) return;
      for (const one of materials) taken.add(one);
      const texture = new THREE.DataTexture(new Uint8Array(TEXELS * TEXELS), TEXELS, TEXELS, THREE.RedFormat);
      texture.magFilter = texture.minFilter = THREE.LinearFilter;
      texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
      this.#layers.push({ mesh, texture });
      for (const one of materials) layOver(one, texture);
    });
    this.#begin();
  }

  /** After an update of the scene. */
  update() {
    for (const { mesh, texture } of this.#layers) {
      const { changed, distances, width } = this.#instance.woundMask(mesh), { data } = texture.image;
      if (changed.width === 0) continue;
      for (let row = changed.top; row < changed.top + changed.height; ++row)
        for (let i = row * width + changed.left, end = i + changed.width; i < end; ++i)
          data[i] = 255 * Math.max(0, 1 - Math.abs(distances[i]) / this.#reach);
      texture.needsUpdate = true;
    }
  }
  /** After a snapshot was restored, which has no masks, or when another instance of the character is shown. */
  restart(instance = this.#instance) {
    this.#instance = instance;
    this.#begin();
  }
  dispose() { for (const { texture } of this.#layers) texture.dispose(); }

  #begin() {
    for (const { mesh } of this.#layers) this.#instance.beginWoundMask({ width: TEXELS, height: TEXELS, reach: this.#reach }, mesh);
  }
}

function layOver(material, texture) {
  const before = material.onBeforeCompile;
  material.onBeforeCompile = (shader, renderer) => {
    before.call(material, shader, renderer);
    shader.uniforms.woundNearness = { value: texture };
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nvarying vec2 vWoundUv;')
      .replace('#include <uv_vertex>', '#include <uv_vertex>\n  vWoundUv = uv;');
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', `#include <common>\n${NOISE}`)
      .replace('#include <color_fragment>', `#include <color_fragment>\n${COLOUR}`);
  };
  material.customProgramCacheKey = () => `wound ${texture.id}`;
  material.needsUpdate = true;
}
