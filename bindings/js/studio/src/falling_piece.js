// A part that came off: a rigid body that falls on the floor.
import * as THREE from 'three';
import { SunderObject, materialsOf } from '../../src/three/sunder_object.js';

const CORNERS = 48;      // vertices that meet the floor: the farthest in that many directions
const BOUNCE = 0.2, FRICTION = 0.6;
const STEP = 1 / 240;    // seconds
const STILL = 0.02;      // metres per second, in sizes

const submeshesOf = (model) => Array.from({ length: model.meshCount }, (_, mesh) => model.mesh(mesh).submeshes);
const materialsIn = (model) => submeshesOf(model).map((submeshes) => submeshes.map(({ material }) => material));

/** Materials of the actor's file, by the numbers that the piece's own file gave them. */
function renumbered(gltf, model, materials) {
  const all = materialsOf(gltf), found = [];
  materialsIn(model).forEach((submeshes, mesh) => submeshes.forEach((material, i) => {
    const original = all[materials[mesh]?.[i]];
    if (original) found[material] = original;
  }));
  return found;
}

/** The farthest vertices of a model in directions that are spread evenly. */
function extremes(model) {
  const points = Array.from({ length: model.meshCount }, (_, mesh) => {
    const { positions, vertexCount } = model.mesh(mesh);
    return Array.from({ length: vertexCount }, (_unused, i) => new THREE.Vector3().fromArray(positions, 3 * i));
  }).flat();
  return Array.from({ length: CORNERS }, (_, i) => {
    const y = 1 - 2 * (i + 0.5) / CORNERS, radius = Math.sqrt(1 - y * y), angle = i * 2.399963;
    const direction = new THREE.Vector3(radius * Math.cos(angle), y, radius * Math.sin(angle));
    return points.reduce((best, point) => (point.dot(direction) > best.dot(direction) ? point : best), points[0]);
  });
}

export class FallingPiece {
  #velocity = new THREE.Vector3();
  #spin = new THREE.Vector3();
  #body;
  #materials;
  #corners;
  #left = 0;
  #gravity;
  #inertia;
  #mass;

  /**
   * @param model  of the piece, whose frame is at its centre of mass; it becomes this object's own
   * @param actor  that it came off
   * @param operations  how many operations are done with that detach: fewer, and the piece is gone
   * @param body  { mass, inertiaPiece, modelFromPiece }, and where it is and how it moves if it has fallen already
   * @param materials  of its submeshes, by mesh, as the actor's file numbers them
   */
  constructor(model, { actor: { parts, model: of, gltf, size }, operations, body, materials = materialsIn(model) }) {
    const { mass, inertiaPiece, modelFromPiece: m } = body;
    this.operations = operations;
    this.model = model;
    this.#body = { mass, inertiaPiece, modelFromPiece: m };
    this.#materials = materials;
    this.instance = parts.spawn(model);
    const names = new Set(submeshesOf(of).flat().map(({ name }) => name));
    this.drawn = new SunderObject(this.instance, { materials: renumbered(gltf, model, materials), isFlesh: ({ name }) => !names.has(name) });
    for (const mesh of this.drawn.children) mesh.castShadow = true;
    // The library poses the piece where it came off; the body moves it from there.
    const modelFromPiece = new THREE.Matrix4().set(m[0], m[3], m[6], m[9], m[1], m[4], m[7], m[10], m[2], m[5], m[8], m[11], 0, 0, 0, 1);
    modelFromPiece.clone().invert().decompose(this.drawn.position, this.drawn.quaternion, this.drawn.scale);
    this.object = new THREE.Group().add(this.drawn);
    modelFromPiece.decompose(this.object.position, this.object.quaternion, this.object.scale);
    this.#corners = extremes(this.model);
    this.#mass = mass;
    // The frame's axes are the principal ones.
    const least = 1e-6 * mass * size * size;
    this.#inertia = new THREE.Vector3(inertiaPiece[0], inertiaPiece[4], inertiaPiece[8]).max(new THREE.Vector3(least, least, least));
    this.#gravity = 9.81 * Math.max(size / 2.5, 0.1);  // as if the character were as large as a person
    this.size = size;
    const { position, quaternion, velocity, spin } = body;
    if (position) this.object.position.fromArray(position);
    if (quaternion) this.object.quaternion.fromArray(quaternion).normalize();
    if (velocity) this.#velocity.fromArray(velocity);
    if (spin) this.#spin.fromArray(spin);
  }

  /** What another page needs to make it again. */
  get state() {
    const { position, quaternion } = this.object;
    return {
      glb: this.model.toGLB(), operations: this.operations, materials: this.#materials,
      body: { ...this.#body, position: position.toArray(), quaternion: quaternion.toArray(), velocity: this.#velocity.toArray(), spin: this.#spin.toArray() },
    };
  }

  step(seconds, floor) {
    for (this.#left += Math.min(seconds, 0.05); this.#left >= STEP; this.#left -= STEP) this.#advance(STEP, floor);
  }

  #advance(dt, floor) {
    const { position, quaternion } = this.object;
    this.#velocity.y -= this.#gravity * dt;
    position.addScaledVector(this.#velocity, dt);
    const angle = this.#spin.length() * dt;
    if (angle > 0) quaternion.premultiply(new THREE.Quaternion().setFromAxisAngle(this.#spin.clone().normalize(), angle)).normalize();
    let deepest = 0;
    for (const corner of this.#corners) {
      const arm = corner.clone().applyQuaternion(quaternion), depth = floor - (arm.y + position.y);
      if (depth <= 0) continue;
      deepest = Math.max(deepest, depth);
      this.#push(arm);
    }
    position.y += deepest;
    if (deepest > 0 && this.#velocity.length() < STILL * this.size) this.#spin.multiplyScalar(0.98);
  }

  /** The impulse of the floor at a point: no way down, and friction. */
  #push(arm) {
    const speed = this.#velocity.clone().add(this.#spin.clone().cross(arm));
    if (speed.y >= 0) return;
    const along = new THREE.Vector3(speed.x, 0, speed.z), normal = new THREE.Vector3(0, 1, 0);
    const down = -(1 + BOUNCE) * speed.y / this.#response(arm, normal);
    const impulse = normal.multiplyScalar(down);
    if (along.length() > 1e-9) {
      const direction = along.clone().normalize();
      impulse.addScaledVector(direction, -Math.min(along.length() / this.#response(arm, direction), FRICTION * down));
    }
    this.#velocity.addScaledVector(impulse, 1 / this.#mass);
    this.#spin.add(this.#turned(arm.clone().cross(impulse)));
  }
  /** How fast a point moves along a direction by a unit impulse along it. */
  #response(arm, direction) {
    return 1 / this.#mass + this.#turned(arm.clone().cross(direction)).cross(arm).dot(direction);
  }
  /** The spin that an angular impulse makes. */
  #turned(impulse) {
    const { quaternion } = this.object;
    return impulse.applyQuaternion(quaternion.clone().invert()).divide(this.#inertia).applyQuaternion(quaternion);
  }

  dispose() {
    this.object.removeFromParent();
    this.drawn.dispose();
    this.instance.dispose();
    this.model.dispose();
  }
}
