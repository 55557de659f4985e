// A model as rigid bodies and joints for a physics engine, and the pose in which bodies hold its bones.
import { SUNDER_COLLIDER_BOX, SUNDER_COLLIDER_CAPSULE, SUNDER_COLLIDER_SPHERE, SUNDER_JOINT_CONE, SUNDER_JOINT_HINGE, sunder_bone_limit, sunder_hull, sunder_ragdoll_body, sunder_ragdoll_options } from '../generated/calls.js';
import { fieldsOf, triple } from './options.js';
import { Owned } from './owned.js';
import { invalidArgument } from './sunder_error.js';

const KINDS = { hinge: SUNDER_JOINT_HINGE, cone: SUNDER_JOINT_CONE };
const KIND_NAMES = { [SUNDER_JOINT_HINGE]: 'hinge', [SUNDER_JOINT_CONE]: 'cone' };
const SHAPES = { [SUNDER_COLLIDER_SPHERE]: 'sphere', [SUNDER_COLLIDER_CAPSULE]: 'capsule', [SUNDER_COLLIDER_BOX]: 'box' };
const NONE = 0xFFFFFFFF;

function limitFields({ bone, kind = 'hinge', axis, lower = 0, upper = 0, cone = 0 }) {
  if (KINDS[kind] === undefined) throw invalidArgument(`kind: '${kind}' is neither hinge nor cone`);
  return { bone, kind: KINDS[kind], axis: [...triple(axis, 'axis')], lower, upper, cone };
}

/** Refuses what the library would read past the end of. */
function sized(values, count, what) {
  if (values?.length !== count) throw invalidArgument(`${what}: ${values?.length} numbers; ${count} are expected`);
}

export class Ragdoll extends Owned {
  #calls;
  #bones;
  #bodies;

  /** @param matrices  the pose in which the model stands, 12 numbers per bone */
  constructor(calls, character, matrices, { limits = [], morphWeights = null, ...options } = {}) {
    const { bone_count, morph_weight_count } = calls.sunder_get_character(character);
    sized(matrices, 12 * bone_count, 'matrices');
    if (morphWeights !== null) sized(morphWeights, morph_weight_count, 'morphWeights');
    const fields = fieldsOf(sunder_ragdoll_options, options);
    if (limits.length) Object.assign(fields, { limits: limits.map(limitFields), limit_count: limits.length });
    super(calls.sunder_create_ragdoll(character, matrices, bone_count, morphWeights, { ...calls.sunder_default_ragdoll_options(), ...fields }), (handle) => {
      calls.sunder_destroy_ragdoll(handle);
      calls.memory.detachViews();
    });
    this.#calls = calls;
    this.#bones = bone_count;
    const { bodies, count } = calls.sunder_get_ragdoll_bodies(this.handle);
    this.#bodies = calls.memory.readStructs(sunder_ragdoll_body, bodies, count).map((body) => ({
      bone: body.bone, parent: body.parent === NONE ? null : body.parent, mass: body.mass, moments: [...body.moments],
      modelFromBody: [...body.model_from_body], parentFromJoint: [...body.parent_from_joint], bodyFromJoint: [...body.body_from_joint],
      shape: { kind: SHAPES[body.shape.shape], size: [...body.shape.size], place: [...body.shape.place], rotation: [...body.shape.rotation] },
      limit: { bone: body.limit.bone, kind: KIND_NAMES[body.limit.kind], axis: [...body.limit.axis], lower: body.limit.lower, upper: body.limit.upper, cone: body.limit.cone },
    }));
  }

  /** Parents before children: { bone, parent, mass, moments, modelFromBody, parentFromJoint, bodyFromJoint, shape, limit }. */
  get bodies() { return this.#bodies; }

  /** Where a pose puts the bodies: 12 numbers each. @param matrices  12 numbers per bone */
  place(matrices) {
    sized(matrices, 12 * this.#bones, 'matrices');
    return this.#written(12 * this.#bodies.length, (to) => this.#calls.sunder_place_bodies(this.handle, matrices, this.#bones, to));
  }
  /** How bodies in these places turn their joints: quaternions x y z w, from the parent's side to the body's. */
  turns(places) {
    sized(places, 12 * this.#bodies.length, 'places');
    return this.#written(4 * this.#bodies.length, (to) => this.#calls.sunder_get_joint_turns(this.handle, places, this.#bodies.length, to));
  }
  /** The pose in which bodies in these places hold the bones, for instance.setMatrices(). */
  matrices(places) {
    sized(places, 12 * this.#bodies.length, 'places');
    return this.#written(12 * this.#bones, (to) => this.#calls.sunder_pose_of_bodies(this.handle, places, this.#bodies.length, to));
  }
  /** The convex hull of each body's part, in its frame, as copies. Fails where the library was built without Qhull, as the one in this package. */
  hulls({ points = 64 } = {}) {
    const { memory } = this.#calls;
    const { hulls, count } = this.#calls.sunder_get_ragdoll_hulls(this.handle, points);
    return memory.readStructs(sunder_hull, hulls, count).map((hull) => ({
      points: memory.viewOf(Float64Array, hull.points, 3 * hull.point_count).slice(),
      triangles: memory.viewOf(Uint32Array, hull.triangles, 3 * hull.triangle_count).slice(), volume: hull.volume }));
  }

  #written(count, write) {
    const m = this.#calls.memory, mark = m.mark();
    try {
      const to = m.room(8 * count);
      write(to);
      return m.viewOf(Float64Array, to, count).slice();
    } finally {
      m.release(mark);
    }
  }
}
