// A model as three.js draws it, coloured by one number per vertex.
import { BufferAttribute, Color, DataTexture, DoubleSide, GLSL3, Mesh, RGBAFormat, ShaderMaterial }
  from 'three';
import { SKINNING, SkinnedGeometry } from '../../page_parts/src/skinned_geometry.js';
import { BEYOND, RAMPS } from './colours.js';

/** Stands for "no value" where numbers are interpolated. */
const MISSING = -1e30;

const vertexShader = `${SKINNING}
in float value;
out vec3 viewNormal;
out vec3 viewPosition;
out float shownValue;

void main() {
  vec4 x, y, z;
  skin(x, y, z);
  vec4 bind = vec4(position, 1.0);
  vec4 seen = modelViewMatrix * vec4(dot(x, bind), dot(y, bind), dot(z, bind), 1.0);
  viewNormal = normalMatrix * vec3(dot(x.xyz, normal), dot(y.xyz, normal), dot(z.xyz, normal));
  viewPosition = seen.xyz;
  shownValue = value;
  gl_Position = projectionMatrix * seen;
}`;

const fragmentShader = `
precision highp float;
uniform sampler2D ramp;
uniform bool shows;
uniform bool isLog;
uniform bool isSigned;
uniform float bottom;
uniform float top;
uniform float threshold;  // 0: none
uniform vec3 clay;
uniform vec3 beyond;
uniform bool isGhost;
in vec3 viewNormal;
in vec3 viewPosition;
in float shownValue;
out vec4 colour;

/** Dark colours of a ramp would hide the shape, so that light is added as well as multiplied. */
vec3 lit(vec3 surface, vec3 normal) {
  float key = max(dot(normal, normalize(vec3(-0.35, 0.6, 0.72))), 0.0);
  float sheen = pow(max(dot(normal, normalize(vec3(-0.2, 0.35, 0.92))), 0.0), 24.0);
  float rim = pow(1.0 - abs(normal.z), 3.0);
  return surface * (0.68 + 0.32 * key) + 0.07 * sheen + 0.10 * rim;
}

/** 1 on a thin line where the value is \`at\`; none where the values of a pixel span the scale. */
float isoline(float at) {
  float width = max(fwidth(shownValue), 1e-20);
  float steep = smoothstep(0.1, 0.25, width / top);
  return (1.0 - smoothstep(0.5, 1.3, abs(shownValue - at) / width)) * (1.0 - steep);
}

void main() {
  vec3 normal = normalize(viewNormal);
  if (!gl_FrontFacing) normal = -normal;
  if (!shows || shownValue < ${MISSING.toExponential()} * 1e-3) {
    float rim = 1.0 - abs(normal.z);
    colour = vec4(lit(clay, normal), isGhost ? 0.05 + 0.75 * rim * rim : 1.0);
    return;
  }
  float fraction = isLog ? (shownValue > 0.0 ? log(shownValue / bottom) / log(top / bottom) : 0.0)
                         : (shownValue - bottom) / (top - bottom);
  if (fraction > 1.0001 || (isSigned && fraction < -0.0001)) {
    float stripe = step(0.5, fract((gl_FragCoord.x + gl_FragCoord.y) / 8.0));
    colour = vec4(mix(beyond, beyond * 0.72, stripe), 1.0);
    return;
  }
  vec3 shade = texture(ramp, vec2(clamp(fraction, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
  shade = lit(shade, normal);
  if (threshold > 0.0) {
    float line = isoline(threshold);
    if (isSigned) line = max(line, isoline(-threshold));
    shade = mix(shade, vec3(1.0), 0.9 * line);
  }
  colour = vec4(shade, 1.0);
}`;

function rampTexture(bytes) {
  const texture = new DataTexture(bytes, bytes.length / 4, 1, RGBAFormat);
  texture.needsUpdate = true;
  return texture;
}

const rampTextures = {
  sequential: rampTexture(RAMPS.sequential), signed: rampTexture(RAMPS.signed),
};

export class Surface {
  constructor(model) {
    this.skinned = new SkinnedGeometry(model);
    const { geometry } = this.skinned;
    geometry.setAttribute('value', new BufferAttribute(new Float32Array(model.vertexCount), 1));
    this.uniforms = {
      ...this.skinned.uniforms,
      ramp: { value: rampTextures.sequential },
      shows: { value: false },
      isLog: { value: false },
      isSigned: { value: false },
      bottom: { value: 0 },
      top: { value: 1 },
      threshold: { value: 0 },
      clay: { value: new Color(0.72, 0.72, 0.72) },
      beyond: { value: new Color().setStyle(BEYOND, 'srgb-linear') },
      isGhost: { value: false },
    };
    this.material = new ShaderMaterial({
      vertexShader, fragmentShader, uniforms: this.uniforms, glslVersion: GLSL3, side: DoubleSide,
    });
    this.mesh = new Mesh(geometry, this.material);
    this.mesh.frustumCulled = false;
  }

  /** @param pose  of skin.js: poseOf() */
  setPose(pose) {
    this.skinned.setPose(pose);
  }

  /** @param values  one per vertex, NaN: none; null shows plain clay. */
  setValues(values) {
    this.uniforms.shows.value = values !== null;
    if (values === null) return;
    const attribute = this.mesh.geometry.getAttribute('value');
    attribute.array.set(values.map((value) => (Number.isNaN(value) ? MISSING : value)));
    attribute.needsUpdate = true;
  }

  setScale(scale, threshold) {
    const { uniforms } = this;
    uniforms.ramp.value = scale.signed ? rampTextures.signed : rampTextures.sequential;
    uniforms.isLog.value = scale.log;
    uniforms.isSigned.value = scale.signed;
    uniforms.bottom.value = scale.bottom;
    uniforms.top.value = scale.top;
    uniforms.threshold.value = threshold ?? 0;
  }

  setClay(r, g, b) {
    this.uniforms.clay.value.setRGB(r, g, b);
  }

  /** A ghost is drawn over what else there is, and clear where it faces the eye. */
  setGhost(isGhost) {
    this.uniforms.isGhost.value = isGhost;
    this.material.transparent = isGhost;
    this.material.depthWrite = !isGhost;
    this.mesh.renderOrder = isGhost ? 1 : 0;
  }
}
