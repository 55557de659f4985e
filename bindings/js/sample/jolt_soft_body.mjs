// A torn mesh as a soft body of Jolt that hangs on the bones of its character.

/** Writes 12 numbers into a 4 x 4 matrix of Jolt. */
function setMatrix(Jolt, matrix, m) {
  for (let k = 0; k < 4; ++k) {
    const column = new Jolt.Vec4(m[3 * k], m[3 * k + 1], m[3 * k + 2], k === 3 ? 1 : 0);
    matrix.SetColumn4(k, column);
    Jolt.destroy(column);
  }
}

/** The influences of each vertex: [[slot, weight], ...]; Jolt takes at most four. */
function influencesOf(mesh) {
  const slots = mesh.influences, weights = new Float32Array(slots.buffer, slots.byteOffset, slots.length), first = mesh.firstInfluence;
  return Array.from({ length: mesh.vertexCount }, (_, v) => {
    const all = Array.from({ length: first[v + 1] - first[v] }, (__, i) => [slots[2 * (first[v] + i)], weights[2 * (first[v] + i) + 1]]);
    const most = all.sort((a, b) => b[1] - a[1]).slice(0, 4), sum = most.reduce((total, [, weight]) => total + weight, 0);
    return most.map(([slot, weight]) => [slot, weight / sum]);
  });
}

/**
 * Adds the body. @param mesh  of a torn instance: instance.source(i) @param skin  model.skins[mesh.skin]
 * Morph targets are not followed. @param maxDistance  metres from the skin
 * @returns { body, follow(matrices, isHard), positions() }: call follow() with 12 numbers per bone before each step, the first
 *          time with true: all vertices are put onto the skin
 */
export function addSoftBody(Jolt, world, mesh, skin, maxDistance) {
  const shared = new Jolt.SoftBodySharedSettings();
  const positions = mesh.positions;  // in bind space
  for (let v = 0; v < mesh.vertexCount; ++v) {
    const vertex = new Jolt.SoftBodySharedSettingsVertex();
    vertex.mPosition = new Jolt.Float3(...positions.subarray(3 * v, 3 * v + 3));
    shared.mVertices.push_back(vertex);
    Jolt.destroy(vertex);
  }
  const triangles = mesh.triangles;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = triangles.subarray(t, t + 3);
    if (a === b) continue;  // removed
    const face = new Jolt.SoftBodySharedSettingsFace(a, b, c, 0);
    shared.AddFace(face);
    Jolt.destroy(face);
  }
  shared.mInvBindMatrices.resize(skin.bones.length);
  skin.bones.forEach((_, slot) => {
    const bind = shared.mInvBindMatrices.at(slot);
    bind.mJointIndex = slot;
    setMatrix(Jolt, bind.mInvBind, skin.boneFromBind.subarray(12 * slot, 12 * slot + 12));
  });
  shared.mSkinnedConstraints.resize(mesh.vertexCount);
  influencesOf(mesh).forEach((influences, v) => {
    const skinned = shared.mSkinnedConstraints.at(v);
    skinned.mVertex = v;
    skinned.mMaxDistance = Math.max(maxDistance, 1e-7);  // Jolt 1.1.0 divides by it
    skinned.mBackStopDistance = 3e38;  // off
    skinned.mBackStopRadius = 40;
    for (let i = 0; i < 4; ++i) {
      const one = skinned.get_mWeights(i), [slot, weight] = influences[i] ?? [0, 0];
      one.mInvBindIndex = slot;
      one.mWeight = weight;
    }
  });
  const attributes = new Jolt.SoftBodySharedSettingsVertexAttributes();
  attributes.mCompliance = attributes.mShearCompliance = 1e-4;
  shared.CreateConstraints(attributes, 1, Jolt.SoftBodySharedSettings_EBendType_None);
  shared.CalculateSkinnedConstraintNormals();
  shared.Optimize();
  const settings = new Jolt.SoftBodyCreationSettings(shared, new Jolt.RVec3(0, 0, 0), Jolt.Quat.prototype.sIdentity(), 1);
  settings.mUpdatePosition = false;
  settings.mMakeRotationIdentity = false;
  settings.mAllowSleeping = false;
  const all = world.GetPhysicsSystem().GetBodyInterface(), body = all.CreateSoftBody(settings);
  all.AddBody(body.GetID(), Jolt.EActivation_Activate);
  const motion = Jolt.castObject(body.GetMotionProperties(), Jolt.SoftBodyMotionProperties);
  const joints = new Jolt.ArrayMat44();
  joints.resize(skin.bones.length);
  return {
    body,
    follow(matrices, isHard = false) {
      skin.bones.forEach((bone, slot) => setMatrix(Jolt, joints.at(slot), matrices.subarray(12 * bone, 12 * bone + 12)));
      motion.SkinVertices(body.GetCenterOfMassTransform(), joints.data(), skin.bones.length, isHard, world.GetTempAllocator());
    },
    positions: () => Float32Array.from({ length: 3 * mesh.vertexCount }, (_, i) => {
      const at = motion.GetVertex(Math.trunc(i / 3)).mPosition;
      return [at.GetX(), at.GetY(), at.GetZ()][i % 3];
    }),
  };
}
