// A model as three.js draws it: base colours, separated pieces and lips.
import {
  BufferAttribute, ClampToEdgeWrapping, DataTexture, DoubleSide, GLSL3, LinearFilter,
  LinearMipmapLinearFilter, Matrix3, Mesh, MirroredRepeatWrapping, NearestFilter, RepeatWrapping,
  ShaderMaterial, Texture, Vector4,
} from 'three';
import { NONE } from '../../page_parts/src/decode.js';
import { poseVertices } from '../../page_parts/src/skin.js';
import { SKINNING, SkinnedGeometry } from '../../page_parts/src/skinned_geometry.js';
import { FatLines } from './fat_lines.js';

const LIP = 0xd6143c;
/** Up to here pieces have colours of their own; told apart by people with colour vision deficiencies. */
export const PIECES = ['#0072b2', '#e69f00', '#009e73', '#cc79a7', '#56b4e9', '#d55e00'];
const MOST_TEXELS = 2048;

const WRAPS = { repeat: RepeatWrapping, clamp: ClampToEdgeWrapping, mirror: MirroredRepeatWrapping };

const vertexShader = `${SKINNING}
in vec4 baseColour;
in float piece;
uniform mat3 imageFromUv;
out vec3 viewNormal;
out vec2 place;
out vec4 vertexColour;
flat out float shownPiece;

void main() {
  vec4 x, y, z;
  skin(x, y, z);
  vec4 bind = vec4(position, 1.0);
  vec4 seen = modelViewMatrix * vec4(dot(x, bind), dot(y, bind), dot(z, bind), 1.0);
  viewNormal = normalMatrix * vec3(dot(x.xyz, normal), dot(y.xyz, normal), dot(z.xyz, normal));
  place = (imageFromUv * vec3(uv, 1.0)).xy;
  vertexColour = baseColour;
  shownPiece = piece;
  gl_Position = projectionMatrix * seen;
}`;

const fragmentShader = `
precision highp float;
uniform sampler2D image;
uniform bool hasImage;
uniform vec4 factor;
uniform float cutoff;
uniform bool showsColours;
uniform vec3 clay;
uniform vec3 pieceColours[${PIECES.length}];
in vec3 viewNormal;
in vec2 place;
in vec4 vertexColour;
flat in float shownPiece;
out vec4 colour;

vec3 decoded(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}
vec3 encoded(vec3 c) {
  return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

vec3 lit(vec3 surface, vec3 normal) {
  float key = max(dot(normal, normalize(vec3(-0.35, 0.6, 0.72))), 0.0);
  float rim = pow(1.0 - abs(normal.z), 3.0);
  return surface * (0.56 + 0.40 * key) + 0.05 * rim;
}

void main() {
  vec3 normal = normalize(viewNormal);
  if (!gl_FrontFacing) normal = -normal;
  vec3 shade = clay;
  if (showsColours) {
    vec4 base = factor * vertexColour;
    if (hasImage) {
      vec4 texel = texture(image, place);
      if (texel.a * base.a < cutoff) discard;
      base.rgb *= decoded(texel.rgb);
    }
    shade = encoded(base.rgb);
  }
  if (shownPiece > 0.5)
    shade = mix(shade, pieceColours[int(shownPiece - 0.5) % ${PIECES.length}], 0.7);
  colour = vec4(lit(shade, normal), 1.0);
}`;

/** What materials without an image show; never seen, but a sampler needs a texture. */
const blank = new DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
blank.needsUpdate = true;

async function bitmapOf({ media, bytes }) {
  const options = { premultiplyAlpha: 'none', colorSpaceConversion: 'none' };
  const bitmap = await createImageBitmap(new Blob([bytes], { type: media }), options);
  const shrink = Math.min(1, MOST_TEXELS / Math.max(bitmap.width, bitmap.height));
  if (shrink === 1) return bitmap;
  return createImageBitmap(bitmap, { ...options, resizeQuality: 'medium',
    resizeWidth: Math.max(1, Math.round(bitmap.width * shrink)),
    resizeHeight: Math.max(1, Math.round(bitmap.height * shrink)) });
}

/** The images of the data; null where the browser cannot decode one. */
export const decodeImages = (data) =>
  Promise.all(data.images.map((image) => bitmapOf(image).catch(() => null)));

function textureOf(bitmap, { wrap: [wrapS, wrapT], is_pixelated }) {
  const texture = new Texture(bitmap);
  texture.wrapS = WRAPS[wrapS];
  texture.wrapT = WRAPS[wrapT];
  texture.flipY = false;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.magFilter = is_pixelated ? NearestFilter : LinearFilter;
  texture.anisotropy = 4;
  texture.needsUpdate = true;
  return texture;
}

/** Corners sorted by material, and the groups of three.js; the page's own order stays for picking. */
function groupByMaterial(model) {
  const { indices, triangle_materials: materials } = model;
  const triangles = Uint32Array.from(materials.keys());
  triangles.sort((a, b) => materials[a] - materials[b] || a - b);
  const sorted = new Uint32Array(indices.length);
  const groups = [];
  triangles.forEach((triangle, i) => {
    sorted.set(indices.subarray(triangle * 3, triangle * 3 + 3), i * 3);
    const last = groups.at(-1);
    if (last?.material === materials[triangle]) last.count += 3;
    else groups.push({ material: materials[triangle], start: i * 3, count: 3 });
  });
  return { sorted, groups };
}

export class ShownModel {
  /** @param bitmaps  of decodeImages(); @param shared  uniforms of all models */
  constructor(model, bitmaps, shared) {
    this.model = model;
    this.skinned = new SkinnedGeometry(model);
    this.shared = shared;
    this.mesh = this.makeMesh(bitmaps);
    this.lips = model.lips?.length ? new FatLines(model.lips.length / 2, LIP, 3.5) : null;
  }

  makeMesh(bitmaps) {
    const { model, skinned: { geometry } } = this;
    const { sorted, groups } = groupByMaterial(model);
    geometry.setIndex(new BufferAttribute(sorted, 1));
    geometry.setAttribute('uv', new BufferAttribute(model.uvs, 2));
    const white = () => new Uint16Array(model.vertexCount * 4).fill(65535);
    geometry.setAttribute('baseColour', new BufferAttribute(model.colours ?? white(), 4, true));
    geometry.setAttribute('piece', new BufferAttribute(
      Float32Array.from(model.piece_of_vertex ?? new Float32Array(model.vertexCount)), 1));
    groups.forEach(({ start, count }, i) => geometry.addGroup(start, count, i));
    const mesh = new Mesh(geometry, groups.map(({ material }) =>
      this.makeMaterial(model.materials[material === NONE ? -1 : material], bitmaps)));
    mesh.frustumCulled = false;
    return mesh;
  }

  makeMaterial(material, bitmaps) {
    const bitmap = bitmaps[material?.image] ?? null;
    const factor = material?.factor ?? [0.6, 0.59, 0.56, 1];
    const imageFromUv = material?.image_from_uv ?? [1, 0, 0, 0, 1, 0];
    return new ShaderMaterial({
      vertexShader, fragmentShader, glslVersion: GLSL3, side: DoubleSide,
      uniforms: {
        ...this.skinned.uniforms, ...this.shared,
        image: { value: bitmap ? textureOf(bitmap, material) : blank },
        hasImage: { value: bitmap !== null },
        imageFromUv: { value: new Matrix3().set(...imageFromUv, 0, 0, 1) },
        factor: { value: new Vector4(...factor) },
        cutoff: { value: material?.cutoff ?? 0 },
      },
    });
  }

  get objects() {
    return this.lips ? [this.mesh, this.lips.object] : [this.mesh];
  }

  /** @param pose  of skin.js: poseOf() */
  setPose(pose) {
    this.skinned.setPose(pose);
    if (this.lips) this.lips.setEnds(poseVertices(this.model, pose, this.model.lips));
  }
}
