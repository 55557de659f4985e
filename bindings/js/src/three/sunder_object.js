// An instance as an object of three.js.
import { DoubleSide, Group, MeshStandardMaterial } from 'three';
import { BoneNodes } from './bone_nodes.js';
import { DrawnMesh } from './drawn_mesh.js';

/** Materials of a loaded glTF by their index in the file. */
export function materialsOf(gltf) {
  const materials = [];
  gltf?.scene?.traverse(({ material }) => {
    for (const one of [material].flat()) {
      const index = one && gltf.parser?.associations?.get(one)?.materials;
      if (index !== undefined) materials[index] ??= one;
    }
  });
  return materials;
}

export class SunderObject extends Group {
  #instance;
  #gltf;
  #nodes = null;
  #materials;
  #plain = null;
  #isFlesh;
  #own = [];
  /** Bytes that the last update() will upload. */
  uploadedBytes = 0;

  /**
   * @param instance  of a Sunder scene
   * @param gltf  what GLTFLoader gave for the same file: its materials are used, and copyPose() reads its bones
   * @param materials  by the index in the file, in place of those of gltf
   * @param flesh  the material of walls and caps
   * @param isFlesh  whether a submesh of the model itself, { name, material }, is one, as in a piece that came off
   */
  constructor(instance, { gltf = null, materials = materialsOf(gltf), flesh = null, isFlesh = () => false } = {}) {
    super();
    this.#instance = instance;
    this.#gltf = gltf;
    this.#materials = materials;
    this.#isFlesh = isFlesh;
    if (flesh === null) this.#own.push(flesh = new MeshStandardMaterial({ color: 0x8c1c1a, roughness: 0.4, side: DoubleSide }));
    this.flesh = flesh;
    this.name = instance.model.name;
    for (let i = 0; i < instance.model.meshCount; ++i) this.add(new DrawnMesh(instance, i, (submesh, isInside) => this.#materialOf(submesh, isInside)));
  }

  get instance() { return this.#instance; }
  /** Shows another instance of the same character from the next update() on. */
  set instance(instance) {
    this.#instance = instance;
    this.#nodes = null;
    for (const mesh of this.children) if (mesh instanceof DrawnMesh) mesh.instance = instance;
  }

  #materialOf(submesh, isInside) {
    if (isInside || this.#isFlesh(submesh)) return this.flesh;
    return this.#materials[submesh.material] ?? this.#plainMaterial();
  }

  #plainMaterial() {
    if (this.#plain === null) this.#own.push(this.#plain = new MeshStandardMaterial({ color: 0xc9a38c, roughness: 0.8 }));
    return this.#plain;
  }

  /** Gives the instance the pose and morph weights of the objects of the loaded glTF, as an AnimationMixer moves them. Before Scene.update(). */
  copyPose() {
    if (this.#gltf === null) throw new Error('copyPose() reads the bones of `gltf`, which the constructor was not given');
    this.#nodes ??= new BoneNodes(this.#instance.model, this.#gltf);
    this.#instance.setMatrices(this.#nodes.matrices(), this.#nodes.morphWeights());
  }

  /** Copies what the last Scene.update() changed. */
  update() {
    this.uploadedBytes = 0;
    for (const mesh of this.children) if (mesh instanceof DrawnMesh) this.uploadedBytes += mesh.update();
  }

  /** A ray of a Raycaster, in the space of the model: { origin, direction }. */
  localRay(ray) {
    this.updateWorldMatrix(true, false);
    const { origin, direction } = ray.clone().applyMatrix4(this.matrixWorld.clone().invert());
    return { origin, direction: direction.normalize() };
  }

  /** Frees the buffers; the instance stays. Materials that were given stay too. */
  dispose() {
    for (const mesh of this.children) if (mesh instanceof DrawnMesh) mesh.geometry.dispose();
    for (const material of this.#own) material.dispose();
  }
}
