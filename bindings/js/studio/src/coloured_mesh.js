// A mesh of the character with colours of its own, in place of its materials.
import * as THREE from 'three';

const SHARED = ['position', 'normal'];

/** A mesh with the buffers of one of the character, and colours of its own. The other one is not drawn meanwhile. */
export class ColouredMesh extends THREE.Mesh {
  #drawn;
  #of = null;
  #colours;
  #heat;
  #unknown;

  /** @param colours  3 per vertex that there is @param unknown  of those that a tear adds, until they are measured */
  constructor(drawn, material, colours, unknown) {
    super(new THREE.BufferGeometry(), []);
    this.#drawn = drawn;
    this.#colours = colours;
    this.#heat = material;
    this.#unknown = unknown;
    this.matrixAutoUpdate = false;
    this.castShadow = this.receiveShadow = true;
    drawn.layers.disableAll();
    drawn.add(this);
    this.follow();
  }
  /** The character's buffers may be other ones after a tear. */
  follow() {
    const { geometry, material } = this.#drawn;
    if (this.#of !== geometry) this.#share(geometry);
    this.geometry.groups = geometry.groups;
    if (this.material.length !== material.length) this.material = material.map(() => this.#heat);
  }
  /** Shows other colours of the vertices that there are. */
  colour(colours) {
    this.#colours = colours;
    const { color } = this.geometry.attributes;
    color.array.set(colours);
    color.needsUpdate = true;
  }
  dispose() {
    this.#drawn.layers.set(0);
    this.removeFromParent();
    this.#release();
  }

  #share(geometry) {
    this.#release();
    this.#of = geometry;
    this.geometry = new THREE.BufferGeometry();
    for (const name of SHARED) if (geometry.attributes[name]) this.geometry.setAttribute(name, geometry.attributes[name]);
    const colour = new THREE.BufferAttribute(new Float32Array(3 * geometry.attributes.position.count), 3);
    for (let v = this.#colours.length / 3; v < colour.count; ++v) this.#unknown.toArray(colour.array, 3 * v);
    colour.array.set(this.#colours);
    this.geometry.setAttribute('color', colour);
    this.geometry.setIndex(geometry.index);
    this.geometry.boundingBox = geometry.boundingBox;
    this.geometry.boundingSphere = geometry.boundingSphere;
  }
  /** Disposing of a geometry drops its buffers, but the character is drawn from the shared ones. */
  #release() {
    for (const name of SHARED) this.geometry.deleteAttribute(name);
    this.geometry.setIndex(null);
    this.geometry.dispose();
  }
}
