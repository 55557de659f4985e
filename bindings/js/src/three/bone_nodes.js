// Which object of a loaded glTF is which bone of a model, and which has its morph weights.
import { Matrix4 } from 'three';

/** The nodes of the scene as the library orders bones: whole trees, parents first, children in their order. */
function orderedNodes({ nodes = [], scenes = [], scene = 0 }) {
  const parents = new Map(nodes.flatMap(({ children = [] }, parent) => children.map((child) => [child, parent])));
  const rootOf = (node) => (parents.has(node) ? rootOf(parents.get(node)) : node);
  const roots = scenes.length ? (scenes[scene].nodes ?? []).map(rootOf) : [...nodes.keys()].filter((node) => !parents.has(node));
  const order = new Set();
  const add = (node) => {
    if (order.has(node)) return;
    order.add(node);
    (nodes[node].children ?? []).forEach(add);
  };
  roots.forEach(add);
  return [...order];
}

/** The morph weights of an object that GLTFLoader made of a node: of its mesh, or of the first of its meshes. */
const influencesOf = (object) => (object.isMesh ? object : object.children.find((mesh) => mesh.isMesh && mesh.morphTargetInfluences))?.morphTargetInfluences;
/** How many morph weights a node's mesh has, in glTF. */
const targetCount = ({ meshes = [] }, { mesh }) => (mesh === undefined ? 0 : Math.max(...meshes[mesh].primitives.map(({ targets = [] }) => targets.length)));

export class BoneNodes {
  #root;
  #objects;
  #matrices;
  #morphed;
  #morphWeights;

  constructor(model, { scene, parser }) {
    this.#root = scene;
    const byNode = new Map();
    scene.traverse((object) => {
      const node = parser.associations.get(object)?.nodes;
      if (node !== undefined && !byNode.has(node)) byNode.set(node, object);
    });
    // A matrix with shear has become two bones; no vertex hangs on the first.
    const bones = model.bones, nodes = orderedNodes(parser.json), objects = nodes.map((node) => byNode.get(node));
    this.#morphed = nodes.map((node) => ({ object: byNode.get(node), count: targetCount(parser.json, parser.json.nodes[node]) }))
      .filter(({ count }) => count > 0);
    this.#morphWeights = new Float32Array(model.morphWeightCount);
    this.#objects = bones.map(({ name }) => (name.endsWith('#shear') ? objects[0] : objects.shift()));
    if (objects.length || this.#objects.includes(undefined))
      throw new Error(`the scene has other nodes than the model has bones (${bones.length}): load both from the same file`);
    this.#matrices = new Float64Array(12 * bones.length);
  }

  /** model_from_bone of each bone, as the objects stand now. */
  matrices() {
    this.#root.updateMatrixWorld(true);
    const inverse = this.#root.matrixWorld.clone().invert(), relative = new Matrix4();
    this.#objects.forEach((object, i) => {
      const { elements } = relative.multiplyMatrices(inverse, object.matrixWorld);
      for (let k = 0; k < 12; ++k) this.#matrices[12 * i + k] = elements[Math.floor(k / 3) * 4 + (k % 3)];
    });
    return this.#matrices;
  }

  /** The weights of all morph targets, as the library orders them: node by node. */
  morphWeights() {
    let first = 0;
    for (const { object, count } of this.#morphed) {
      const influences = influencesOf(object) ?? [];
      for (let i = 0; i < count; ++i) this.#morphWeights[first + i] = influences[i] ?? 0;
      first += count;
    }
    return this.#morphWeights;
  }
}
