// A ragdoll of sunder-tear in a world of Rapier (@dimforge/rapier3d-compat).
import { axisOf, join, split } from './frames.mjs';

const vector = ([x, y, z]) => ({ x, y, z });
const quaternion = ([x, y, z, w]) => ({ x, y, z, w });

function colliderOf(RAPIER, { kind, size, place, rotation }) {
  const { ColliderDesc } = RAPIER;
  const shape = kind === 'sphere' ? ColliderDesc.ball(size[0]) :
    kind === 'capsule' ? ColliderDesc.capsule(size[1], size[0]) : ColliderDesc.cuboid(...size);
  // Parts of one ragdoll overlap at their joints: members of group 2 collide with all but that group. The body has the mass.
  return shape.setTranslation(...place).setRotation(quaternion(rotation)).setMass(0).setFriction(0.8).setCollisionGroups(0x0002FFFD);
}

/** Adds bodies and joints. @returns { bodies, places() }: 12 numbers per body, for ragdoll.matrices() */
export function addToRapier(RAPIER, world, ragdoll) {
  const bodies = ragdoll.bodies.map((of) => {
    const { place, turn } = split(of.modelFromBody);
    const body = world.createRigidBody(RAPIER.RigidBodyDesc.dynamic().setTranslation(...place).setRotation(quaternion(turn))
      .setLinearDamping(0.05).setAngularDamping(0.3)
      .setAdditionalMassProperties(of.mass, { x: 0, y: 0, z: 0 }, vector(of.moments), { x: 0, y: 0, z: 0, w: 1 }));
    world.createCollider(colliderOf(RAPIER, of.shape), body);
    return body;
  });
  ragdoll.bodies.forEach((of, i) => {
    if (of.parent === null) return;
    const anchors = [of.parentFromJoint, of.bodyFromJoint].map((frame) => vector(split(frame).place));
    if (of.limit.kind === 'cone') {  // whose limits Rapier's JavaScript does not offer
      world.createImpulseJoint(RAPIER.JointData.spherical(...anchors), bodies[of.parent], bodies[i], true);
      return;
    }
    const axes = [of.parentFromJoint, of.bodyFromJoint].map((frame) => vector(axisOf(frame, 0)));
    const joint = world.createImpulseJoint(RAPIER.JointData.revoluteWithAxes(...anchors, ...axes), bodies[of.parent], bodies[i], true);
    joint.setLimits(of.limit.lower, of.limit.upper);
  });
  const placeOf = (body) => {
    const { x, y, z } = body.translation(), q = body.rotation();
    return join([x, y, z], [q.x, q.y, q.z, q.w]);
  };
  return { bodies, places: () => Float64Array.from(bodies.flatMap(placeOf)) };
}
