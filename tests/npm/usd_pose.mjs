// Poses the skinned meshes of a USD text (.usda) or package (.usdz), in two ways, neither of which is ours:
//
//   node usd_pose.mjs spec  <in.usda> <out> <clip> <seconds...>
//     reads the text by three's parser and applies what UsdSkel says, in double: every influence, blend shapes, joints that
//     an animation leaves out. Writes the points of each mesh.
//   node usd_pose.mjs three <in.usda|in.usdz> <out> <clip> <seconds...>
//     three's USDLoader and AnimationMixer. Writes the corners of each mesh, by its subsets. At most four influences per
//     vertex, and no blend shapes: it knows no others.
//
// <clip> is the name of a SkelAnimation, or "-" for the pose at rest. Output: doubles, per moment and mesh, in the order of the file.
import { readFileSync, writeFileSync } from 'node:fs';

globalThis.self = globalThis;
globalThis.window = globalThis;
globalThis.document = { createElementNS: () => ({ addEventListener() {}, removeEventListener() {}, style: {} }) };
console.warn = () => {};

const { AnimationMixer, LoopOnce, Matrix4, Quaternion, Vector3 } = await import('three');
const { USDLoader } = await import('three/addons/loaders/USDLoader.js');
const { USDAParser } = await import('three/addons/loaders/usd/USDAParser.js');

const [way, input, output, clip, ...moments] = process.argv.slice(2);
const bytes = readFileSync(input);
const text = input.endsWith('.usda') ? bytes.toString() : undefined;
const numbers = [];

// ---- By the text.

/** Of rows as USD has them. */
function matrixOf(rows) {
  return new Matrix4().fromArray(rows.flat(3));
}

class Layer {
  constructor(specs) {
    this.specs = specs;
    const of = (type) => Object.keys(specs).filter((path) => specs[path].fields.typeName === type);
    this.rate = specs['/'].fields.timeCodesPerSecond;
    this.meshes = of('Mesh');
    const skeletons = of('Skeleton');
    if (skeletons.length !== 1) throw new Error(`${skeletons.length} skeletons`);
    this.skeleton = skeletons[0];
    this.animation = of('SkelAnimation').find((path) => path.endsWith(`/${clip}`));
    if (clip !== '-' && !this.animation) throw new Error(`no animation ${clip}`);
  }

  value(path, name) {
    return this.specs[`${path}.${name}`]?.fields.default;
  }

  targets(path, name) {
    const [all] = this.specs[`${path}.${name}`].fields.targetPaths;
    return all.replace(/[[\]]/g, '').split(',').map((one) => one.trim());
  }

  /** An array of an animation at a time code, its entries of `width` numbers interpolated. */
  sample(name, code, width) {
    const { times, values } = this.specs[`${this.animation}.${name}`].fields.timeSamples;
    let after = times.findIndex((time) => time > code);
    if (after === 0) return values[0];
    if (after < 0) return values.at(-1);
    const share = (code - times[after - 1]) / (times[after] - times[after - 1]);
    const [from, to] = [values[after - 1], values[after]];
    if (width !== 4) return from.map((number, i) => number + share * (to[i] - number));
    const result = [];
    for (let i = 0; i < from.length; i += 4) result.push(...new Quaternion(...from.slice(i, i + 4)).slerp(new Quaternion(...to.slice(i, i + 4)), share));
    return result;
  }

  /** The matrix of each joint in the space of the skeleton. */
  joints(seconds) {
    const names = this.value(this.skeleton, 'joints');
    const rest = this.value(this.skeleton, 'restTransforms').flat(3);
    const local = names.map((_, i) => matrixOf(rest.slice(16 * i, 16 * i + 16)));
    if (this.animation) {
      const moved = this.value(this.animation, 'joints');
      if (moved.length > 0 && moved[0] !== '') {
        const code = seconds * this.rate;
        const [places, turns, scales] = [this.sample('translations', code, 3), this.sample('rotations', code, 4), this.sample('scales', code, 3)];
        moved.forEach((name, i) => {
          const joint = names.indexOf(name);
          if (joint < 0) throw new Error(`the animation moves ${name}, which is no joint`);
          local[joint].compose(new Vector3(...places.slice(3 * i)), new Quaternion(...turns.slice(4 * i, 4 * i + 4)).normalize(), new Vector3(...scales.slice(3 * i)));
        });
      }
    }
    const world = [];
    names.forEach((name, i) => {
      const parent = names.indexOf(name.slice(0, Math.max(name.lastIndexOf('/'), 0)));
      if (parent >= i) throw new Error(`${name} stands before its parent`);
      world.push(parent < 0 ? local[i] : new Matrix4().multiplyMatrices(world[parent], local[i]));
    });
    return { names, world };
  }

  weightOf(shape, seconds) {
    if (!this.animation) return 0;
    const i = this.value(this.animation, 'blendShapes').indexOf(shape);
    if (i < 0) throw new Error(`no animation of the blend shape ${shape}`);
    return this.sample('blendShapeWeights', seconds * this.rate, 1)[i];
  }

  shapedPoints(mesh, seconds) {
    const points = [...this.value(mesh, 'points')];
    const shapes = this.value(mesh, 'skel:blendShapes') ?? [];
    shapes.forEach((shape, i) => {
      const path = this.targets(mesh, 'skel:blendShapeTargets')[i];
      const [offsets, vertices] = [this.value(path, 'offsets'), this.value(path, 'pointIndices')];
      const weight = this.weightOf(shape, seconds);
      vertices.filter((vertex) => vertex !== '').forEach((vertex, k) => {
        for (let c = 0; c < 3; ++c) points[3 * vertex + c] += weight * offsets[3 * k + c];
      });
    });
    return points;
  }

  posed(mesh, seconds) {
    if (this.targets(mesh, 'skel:skeleton')[0] !== this.skeleton) throw new Error(`${mesh} names another skeleton`);
    const points = this.shapedPoints(mesh, seconds);
    const { names, world } = this.joints(seconds);
    const bind = this.value(this.skeleton, 'bindTransforms').flat(3);
    const placed = matrixOf(this.value(mesh, 'primvars:skel:geomBindTransform'));
    const moves = this.value(mesh, 'skel:joints').map((name) => {
      const j = names.indexOf(name);
      return new Matrix4().multiplyMatrices(world[j], matrixOf(bind.slice(16 * j, 16 * j + 16)).invert()).multiply(placed);
    });
    const [slots, weights] = [this.value(mesh, 'primvars:skel:jointIndices'), this.value(mesh, 'primvars:skel:jointWeights')];
    const size = slots.length / (points.length / 3);
    const result = [];
    for (let v = 0; v < points.length / 3; ++v) {
      const [point, sum] = [new Vector3(...points.slice(3 * v, 3 * v + 3)), new Vector3()];
      for (let k = v * size; k < (v + 1) * size; ++k)
        if (weights[k] !== 0) sum.addScaledVector(point.clone().applyMatrix4(moves[slots[k]]), weights[k]);
      result.push(...sum);
    }
    return result;
  }
}

function poseBySpec() {
  const layer = new Layer(new USDAParser().parseData(text).specsByPath);
  for (const seconds of moments.length > 0 ? moments.map(Number) : [0])
    for (const mesh of layer.meshes) for (const number of layer.posed(mesh, seconds)) numbers.push(number);
}

// ---- By three's loader.

function poseByThree() {
  const root = new USDLoader().parse(text ?? bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), '');
  const mixer = new AnimationMixer(root);
  if (clip !== '-') {
    const action = mixer.clipAction(root.animations.find((one) => one.name === clip)).setLoop(LoopOnce).play();
    action.clampWhenFinished = true;
  }
  const point = new Vector3();
  for (const seconds of moments.length > 0 ? moments.map(Number) : [0]) {
    if (clip !== '-') mixer.setTime(seconds);
    root.updateMatrixWorld(true);
    root.traverse((mesh) => {
      if (!mesh.isSkinnedMesh) return;
      for (let i = 0; i < mesh.geometry.attributes.position.count; ++i) numbers.push(...mesh.getVertexPosition(i, point).applyMatrix4(mesh.matrixWorld));
    });
  }
}

way === 'spec' ? poseBySpec() : poseByThree();
writeFileSync(output, new Float64Array(numbers));
