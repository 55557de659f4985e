// The threads of sutures, drawn as stitches across the lips that they hold.
import * as THREE from 'three';

/** Shares of the size: how far a stitch reaches beyond each lip, and its radius. */
const REACH = 0.009, RADIUS = 0.0013;

export class Stitches {
  #instance;
  #object;
  #size;
  #drawn = null;

  /** @param object  the SunderObject of the instance @param size  of the character, metres */
  constructor(instance, object, size) {
    this.#instance = instance;
    this.#object = object;
    this.#size = size;
  }
  /** Another instance of the character is shown. */
  set instance(instance) { this.#instance = instance; }
  get count() { return this.#drawn?.count ?? 0; }

  /** After an update of the scene. */
  update() {
    const holding = this.#instance.threads.filter(({ left, right, isBroken }) => left && right && !isBroken);
    if (holding.length === 0 && !this.#drawn) return;
    this.#makeRoom(holding.length);
    const meshes = this.#object.children.map((_, mesh) => this.#instance.mesh(mesh));
    const vector = ({ mesh, vertex }, array) => new THREE.Vector3().fromArray(meshes[mesh][array] ?? [0, 0, 0], 3 * vertex);
    const ends = holding.map(({ left, right }) => {
      const from = vector(left, 'positions'), to = vector(right, 'positions');
      return { from, to, middle: from.clone().lerp(to, 0.5), normal: vector(left, 'normals').add(vector(right, 'normals')).normalize() };
    });
    const place = new THREE.Matrix4(), turn = new THREE.Matrix4(), reach = REACH * this.#size, radius = RADIUS * this.#size;
    ends.forEach((end, i) => {
      const across = this.#across(ends, i), side = across.clone().cross(end.normal);
      const length = end.from.distanceTo(end.to) + 2 * reach;
      turn.makeBasis(across, end.normal, side);
      place.makeScale(length, radius, radius).premultiply(turn).setPosition(end.middle.addScaledVector(end.normal, radius));
      this.#drawn.setMatrixAt(i, place);
    });
    this.#drawn.count = ends.length;
    this.#drawn.instanceMatrix.needsUpdate = true;
  }

  /** From lip to lip, in the surface: square to the line of threads, because lips that are closed lie at one place. */
  #across(ends, i) {
    const { middle, normal, from, to } = ends[i];
    const along = new THREE.Vector3();
    for (const other of [ends[i - 1], ends[i + 1]])
      if (other && (along.lengthSq() === 0 || other.middle.distanceTo(middle) < along.length())) along.copy(other.middle).sub(middle);
    const across = along.lengthSq() > 0 ? along.cross(normal) : to.clone().sub(from);
    across.addScaledVector(normal, -across.dot(normal));
    if (across.lengthSq() === 0) across.set(normal.y, normal.z, normal.x).cross(normal);
    return across.normalize();
  }

  #makeRoom(count) {
    if (this.#drawn && this.#drawn.instanceMatrix.count >= count) return;
    this.dispose();
    const bar = new THREE.CylinderGeometry(1, 1, 1, 6).rotateZ(Math.PI / 2);
    this.#drawn = new THREE.InstancedMesh(bar, new THREE.MeshStandardMaterial({ color: 0x14141a, roughness: 0.6 }), 2 * count);
    this.#drawn.frustumCulled = false;
    this.#drawn.castShadow = true;
    this.#object.parent.add(this.#drawn);
  }
  dispose() {
    this.#drawn?.removeFromParent();
    this.#drawn?.geometry.dispose();
    this.#drawn?.material.dispose();
    this.#drawn?.dispose();
    this.#drawn = null;
  }
}
