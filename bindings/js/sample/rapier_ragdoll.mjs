// A ragdoll of sunder-tear in a world of Rapier (@dimforge/rapier3d-compat).
import { conjugate, join, multiply, split, turned } from './frames.mjs';

const vector = ([x, y, z]) => ({ x, y, z });
const quaternion = ([x, y, z, w]) => ({ x, y, z, w });

function colliderOf(RAPIER, { kind, size, place, rotation }, back) {
  const { ColliderDesc } = RAPIER;
  const shape = kind === 'sphere' ? ColliderDesc.ball(size[0]) :
    kind === 'capsule' ? ColliderDesc.capsule(size[1], size[0]) : ColliderDesc.cuboid(...size);
  // Parts of one ragdoll overlap at their joints: members of group 2 collide with all but that group. The body has the mass.
  return shape.setTranslation(...turned(back, place)).setRotation(quaternion(multiply(back, rotation)))
    .setMass(0).setFriction(0.8).setCollisionGroups(0x0002FFFD);
}

/** A joint of Rapier has no frames of its own: it counts angles from where the axes of both bodies agree. So each body of Rapier is
 * turned against ours, such that its axes agree with those of its parent where our angles are zero. @returns ours from Rapier's */
function turnsOfBodies(bodies) {
  const turns = [];
  for (const { parent, parentFromJoint, bodyFromJoint } of bodies)
    turns.push(parent === null ? [0, 0, 0, 1] :
      multiply(multiply(split(bodyFromJoint).turn, conjugate(split(parentFromJoint).turn)), turns[parent]));
  return turns;
}

/** Adds bodies and joints. @returns { bodies, places() }: 12 numbers per body, for ragdoll.matrices() */
export function addToRapier(RAPIER, world, ragdoll) {
  const turns = turnsOfBodies(ragdoll.bodies);
  const bodies = ragdoll.bodies.map((of, i) => {
    const { place, turn } = split(of.modelFromBody), back = conjugate(turns[i]);
    const body = world.createRigidBody(RAPIER.RigidBodyDesc.dynamic().setTranslation(...place).setRotation(quaternion(multiply(turn, turns[i])))
      .setLinearDamping(0.05).setAngularDamping(0.3)
      .setAdditionalMassProperties(of.mass, { x: 0, y: 0, z: 0 }, vector(of.moments), quaternion(back)));
    world.createCollider(colliderOf(RAPIER, of.shape, back), body);
    return body;
  });
  ragdoll.bodies.forEach((of, i) => {
    if (of.parent === null) return;
    const back = conjugate(turns[of.parent]), joint = split(of.parentFromJoint);
    const anchors = [vector(turned(back, joint.place)), vector(turned(conjugate(turns[i]), split(of.bodyFromJoint).place))];
    if (of.limit.kind === 'cone') {  // whose limits Rapier's JavaScript does not offer
      world.createImpulseJoint(RAPIER.JointData.spherical(...anchors), bodies[of.parent], bodies[i], true);
      return;
    }
    const axis = vector(turned(back, turned(joint.turn, [1, 0, 0])));
    world.createImpulseJoint(RAPIER.JointData.revolute(...anchors, axis), bodies[of.parent], bodies[i], true)
      .setLimits(Math.max(of.limit.lower, -Math.PI), Math.min(of.limit.upper, Math.PI));
  });
  const placeOf = (body, i) => {
    const { x, y, z } = body.translation(), q = body.rotation();
    return join([x, y, z], multiply([q.x, q.y, q.z, q.w], conjugate(turns[i])));
  };
  return { bodies, turns, places: () => Float64Array.from(bodies.flatMap(placeOf)) };
}
