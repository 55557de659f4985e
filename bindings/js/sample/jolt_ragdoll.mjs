// A ragdoll of sunder-tear in a world of Jolt (jolt-physics).
import { axisOf, join, split } from './frames.mjs';

/** Layers: 0 stands still, 1 moves. */
export function createJoltWorld(Jolt) {
  const settings = new Jolt.JoltSettings();
  const layers = new Jolt.ObjectLayerPairFilterTable(2);
  layers.EnableCollision(0, 1);
  layers.EnableCollision(1, 1);
  const broad = new Jolt.BroadPhaseLayerInterfaceTable(2, 2);
  broad.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
  broad.MapObjectToBroadPhaseLayer(1, new Jolt.BroadPhaseLayer(1));
  settings.mObjectLayerPairFilter = layers;
  settings.mBroadPhaseLayerInterface = broad;
  settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 2, layers, 2);
  const world = new Jolt.JoltInterface(settings);
  Jolt.destroy(settings);
  return world;
}

function shapeOf(Jolt, { kind, size, place, rotation }) {
  const shape = kind === 'sphere' ? new Jolt.SphereShapeSettings(size[0]) :
    kind === 'capsule' && size[1] > 1e-4 ? new Jolt.CapsuleShapeSettings(size[1], size[0]) :
      kind === 'capsule' ? new Jolt.SphereShapeSettings(size[0]) :
        new Jolt.BoxShapeSettings(new Jolt.Vec3(...size), 0.1 * Math.min(...size));
  // Jolt turns about the centre of the shape; the body's origin is its centre of mass.
  const turned = new Jolt.RotatedTranslatedShapeSettings(new Jolt.Vec3(...place), new Jolt.Quat(...rotation), shape);
  return new Jolt.OffsetCenterOfMassShapeSettings(new Jolt.Vec3(...place.map((x) => -x)), turned).Create().Get();
}

function constraintOf(Jolt, { limit, parentFromJoint, bodyFromJoint }) {
  const [at1, at2] = [parentFromJoint, bodyFromJoint].map((frame) => new Jolt.RVec3(...split(frame).place));
  const axes = (axis) => [parentFromJoint, bodyFromJoint].map((frame) => new Jolt.Vec3(...axisOf(frame, axis)));
  if (limit.kind === 'hinge') {
    const hinge = new Jolt.HingeConstraintSettings();
    hinge.mSpace = Jolt.EConstraintSpace_LocalToBodyCOM;
    [hinge.mPoint1, hinge.mPoint2] = [at1, at2];
    [hinge.mHingeAxis1, hinge.mHingeAxis2] = axes(0);
    [hinge.mNormalAxis1, hinge.mNormalAxis2] = axes(1);
    hinge.mLimitsMin = Math.max(Math.min(limit.lower, 0), -Math.PI);  // Jolt wants zero within
    hinge.mLimitsMax = Math.min(Math.max(limit.upper, 0), Math.PI);
    return hinge;
  }
  const cone = new Jolt.SwingTwistConstraintSettings();
  cone.mSpace = Jolt.EConstraintSpace_LocalToBodyCOM;
  [cone.mPosition1, cone.mPosition2] = [at1, at2];
  [cone.mTwistAxis1, cone.mTwistAxis2] = axes(0);
  [cone.mPlaneAxis1, cone.mPlaneAxis2] = axes(1);
  cone.mNormalHalfConeAngle = cone.mPlaneHalfConeAngle = Math.min(limit.cone, Math.PI);
  cone.mTwistMinAngle = Math.max(Math.min(limit.lower, 0), -Math.PI);
  cone.mTwistMaxAngle = Math.min(Math.max(limit.upper, 0), Math.PI);
  return cone;
}

/** Adds bodies and joints. @returns { bodies, places() }: 12 numbers per body, for ragdoll.matrices() */
export function addToJolt(Jolt, world, ragdoll) {
  const system = world.GetPhysicsSystem(), all = system.GetBodyInterface();
  // Parts of one ragdoll overlap at their joints: they do not collide with one another.
  const filter = new Jolt.GroupFilterTable(ragdoll.bodies.length);
  ragdoll.bodies.forEach((_, i) => { for (let j = 0; j < i; ++j) filter.DisableCollision(i, j); });
  const bodies = ragdoll.bodies.map((of, i) => {
    const { place, turn } = split(of.modelFromBody);
    const settings = new Jolt.BodyCreationSettings(shapeOf(Jolt, of.shape), new Jolt.RVec3(...place), new Jolt.Quat(...turn), Jolt.EMotionType_Dynamic, 1);
    settings.mOverrideMassProperties = Jolt.EOverrideMassProperties_MassAndInertiaProvided;
    settings.mMassPropertiesOverride.mMass = of.mass;
    settings.mMassPropertiesOverride.mInertia = Jolt.Mat44.prototype.sScaleVec3(new Jolt.Vec3(...of.moments));
    settings.mFriction = 0.8;
    settings.mLinearDamping = 0.05;
    settings.mAngularDamping = 0.3;
    settings.mCollisionGroup = new Jolt.CollisionGroup(filter, 0, i);
    const body = all.CreateBody(settings);
    all.AddBody(body.GetID(), Jolt.EActivation_Activate);
    Jolt.destroy(settings);
    return body;
  });
  ragdoll.bodies.forEach((of, i) => {
    if (of.parent !== null) system.AddConstraint(constraintOf(Jolt, of).Create(bodies[of.parent], bodies[i]));
  });
  const placeOf = (body) => {
    const at = body.GetCenterOfMassPosition(), q = body.GetRotation();
    return join([at.GetX(), at.GetY(), at.GetZ()], [q.GetX(), q.GetY(), q.GetZ(), q.GetW()]);
  };
  return { bodies, places: () => Float64Array.from(bodies.flatMap(placeOf)) };
}
