// A severed limb falls as a ragdoll in worlds of Rapier and Jolt while the torn body moves on; a Jolt soft body made of a torn
// mesh follows our skin.
import assert from 'node:assert/strict';
import test from 'node:test';
import RAPIER from '@dimforge/rapier3d-compat';
import initJolt from 'jolt-physics';
import { Sunder } from 'sunder-tear';
import { conjugate, multiply, transform, turned } from '../sample/frames.mjs';
import { addToJolt, createJoltWorld } from '../sample/jolt_ragdoll.mjs';
import { addSoftBody } from '../sample/jolt_soft_body.mjs';
import { addToRapier } from '../sample/rapier_ragdoll.mjs';
import { rig, rigNames } from './support.mjs';

const GRAVITY = 9.81, FRAME = 1 / 60;

/** The tube's upper part comes off while its clip plays. */
async function severedTube() {
  const model = await Sunder.load(rig('tube'), { soft: false });
  const scene = await Sunder.createScene();
  const it = scene.spawn(model);
  it.play(0);
  for (let frame = 0; frame < 20; ++frame) scene.update(FRAME);
  const heights = it.matrices.filter((_, i) => i % 12 === 10), middle = (Math.min(...heights) + Math.max(...heights)) / 2;
  it.cut({ point: [0, middle, 0], normal: [0, 1, 0], caps: true });
  const command = it.detach({ point: [0, 1000, 0], motion: 'animated' });
  scene.update(0);
  assert.equal(command.result.error, null);
  const limb = command.result.piece.toModel({ soft: false });
  return { model, scene, it, limb, piece: command.result.piece, pose: it.matrices.slice() };
}

const energyOf = (ragdoll, states) => ragdoll.bodies.reduce((sum, body, i) => {
  const { speed, spin, height } = states[i];
  return sum + body.mass * (0.5 * speed.reduce((s, x) => s + x * x, 0) + GRAVITY * height) +
    0.5 * spin.reduce((s, x, k) => s + body.moments[k] * x * x, 0);
}, 0);

/** Lets a limb fall for 20 seconds. @param world  { add(ragdoll), step(), states() }: spins along the axes of the bodies */
async function fall(world) {
  const { scene, it, limb, piece, pose } = await severedTube();
  const ragdoll = limb.ragdoll(pose);
  assert.ok(ragdoll.bodies.length >= 2);
  const mass = ragdoll.bodies.reduce((sum, body) => sum + body.mass, 0);
  assert.ok(Math.abs(mass - piece.info.mass) < 1e-5 * mass);
  const limp = world.add(ragdoll), fallen = scene.spawn(limb);
  const start = energyOf(ragdoll, world.states(limp)), before = it.matrices.slice();
  let most = start, lowest = Infinity, gap = 0, moved = 0;
  for (let frame = 0; frame < 20 * 60; ++frame) {
    world.step();
    const places = limp.places();
    fallen.setMatrices(ragdoll.matrices(places));
    scene.update(FRAME);
    moved = Math.max(moved, ...it.matrices.map((x, i) => Math.abs(x - before[i])));
    most = Math.max(most, energyOf(ragdoll, world.states(limp)));
    ragdoll.bodies.forEach((body, i) => {
      if (body.parent === null) return;
      const at = transform(places.slice(12 * body.parent, 12 * body.parent + 12), body.parentFromJoint.slice(9));
      const to = transform(places.slice(12 * i, 12 * i + 12), body.bodyFromJoint.slice(9));
      gap = Math.max(gap, Math.hypot(...at.map((x, k) => x - to[k])));
    });
    if (frame > 15 * 60) lowest = Math.min(lowest, ...fallen.mesh(0).positions.filter((_, i) => i % 3 === 1));
  }
  assert.ok(most - start < 0.02 * mass * GRAVITY, `energy rose from ${start} to ${most}`);
  assert.ok(gap < 0.05, `joints part by ${gap}`);
  assert.ok(Math.abs(lowest) < 0.1, `the limb lies at ${lowest}`);
  assert.ok(moved > 1e-3, 'the torn body moves on');
}

test('a severed limb falls as a ragdoll of Rapier', async () => {
  await RAPIER.init();
  const world = new RAPIER.World({ x: 0, y: -GRAVITY, z: 0 });
  world.createCollider(RAPIER.ColliderDesc.cuboid(100, 1, 100).setTranslation(0, -1, 0).setFriction(0.8));
  world.timestep = FRAME / 4;
  world.numSolverIterations = 12;
  await fall({
    add: (ragdoll) => addToRapier(RAPIER, world, ragdoll),
    step: () => { for (let i = 0; i < 4; ++i) world.step(); },
    states: ({ bodies, turns }) => bodies.map((body, i) => {
      const v = body.linvel(), w = body.angvel(), { x, y, z, w: real } = body.rotation();
      const turn = multiply([x, y, z, real], conjugate(turns[i]));
      return { speed: [v.x, v.y, v.z], spin: turned(conjugate(turn), [w.x, w.y, w.z]), height: body.translation().y };
    }),
  });
});

test('a severed limb falls as a ragdoll of Jolt', async () => {
  const Jolt = await initJolt(), world = createJoltWorld(Jolt), all = world.GetPhysicsSystem().GetBodyInterface();
  const floor = new Jolt.BodyCreationSettings(new Jolt.BoxShape(new Jolt.Vec3(100, 1, 100)), new Jolt.RVec3(0, -1, 0), Jolt.Quat.prototype.sIdentity(), Jolt.EMotionType_Static, 0);
  all.AddBody(all.CreateBody(floor).GetID(), Jolt.EActivation_DontActivate);
  world.GetPhysicsSystem().SetGravity(new Jolt.Vec3(0, -GRAVITY, 0));
  await fall({
    add: (ragdoll) => addToJolt(Jolt, world, ragdoll),
    step: () => world.Step(FRAME, 4),
    states: ({ bodies }) => bodies.map((body) => {
      const v = body.GetLinearVelocity(), speed = [v.GetX(), v.GetY(), v.GetZ()];
      const w = body.GetRotation().Conjugated().MulVec3(body.GetAngularVelocity());
      return { speed, spin: [w.GetX(), w.GetY(), w.GetZ()], height: body.GetCenterOfMassPosition().GetY() };
    }),
  });
});

/** Without gravity, hinges of any frame that start within their limits stay where they are; those pushed end at their limits. */
async function hingesStay(add, step, push) {
  const model = await Sunder.load(rig('tube'), { soft: false });
  const bones = model.ragdoll().bodies.map(({ bone }) => bone).slice(1);
  for (const axis of [[1, 0, 0], [0, 0, 1], [0.3, -0.5, 0.8], [-1, 0.2, 0]]) {
    const limits = bones.map((bone) => ({ bone, kind: 'hinge', axis, lower: -0.1, upper: 0.4 }));
    const ragdoll = model.ragdoll(undefined, { limits }), limp = add(ragdoll);
    const angleOf = () => {
      const turns = ragdoll.turns(limp.places());
      return ragdoll.bodies.map(({ parent }, i) => (parent === null ? 0 : 2 * Math.atan2(turns[4 * i], turns[4 * i + 3])));
    };
    for (let i = 0; i < 60; ++i) step();
    for (const angle of angleOf()) assert.ok(Math.abs(angle) < 0.02, `a hinge at rest turns to ${angle}`);
    for (const [sign, end] of [[1, 0.4], [-1, -0.1]]) {
      for (let i = 0; i < 240; ++i) {
        push(limp, ragdoll, sign);
        step();
      }
      const angle = angleOf()[1];
      assert.ok(Math.abs(angle - end) < 0.1, `a hinge that is pushed ends at ${angle}, not ${end}`);
    }
  }
}

test('hinges of Rapier and Jolt turn from where ours do, within our limits', async () => {
  await RAPIER.init();
  const world = new RAPIER.World({ x: 0, y: 0, z: 0 });
  const axisNow = (ragdoll, places) => [0, 1, 2].map((k) => transform([...places.slice(12, 21), 0, 0, 0], ragdoll.bodies[1].bodyFromJoint.slice(0, 3))[k]);
  const torqueOf = (ragdoll, limp, sign) => axisNow(ragdoll, limp.places()).map((x) => sign * 3 * ragdoll.bodies[1].moments[2] * x);
  await hingesStay((ragdoll) => addToRapier(RAPIER, world, ragdoll), () => world.step(), (limp, ragdoll, sign) => {
    const [x, y, z] = torqueOf(ragdoll, limp, sign);
    limp.bodies[1].resetTorques(true);
    limp.bodies[1].addTorque({ x, y, z }, true);
    limp.bodies[0].resetTorques(true);
    limp.bodies[0].addTorque({ x: -x, y: -y, z: -z }, true);
  });
  const Jolt = await initJolt(), space = createJoltWorld(Jolt);
  space.GetPhysicsSystem().SetGravity(new Jolt.Vec3(0, 0, 0));
  await hingesStay((ragdoll) => addToJolt(Jolt, space, ragdoll), () => space.Step(FRAME, 2), (limp, ragdoll, sign) => {
    const torque = torqueOf(ragdoll, limp, sign);
    for (const body of limp.bodies) space.GetPhysicsSystem().GetBodyInterface().ActivateBody(body.GetID());
    limp.bodies[1].AddTorque(new Jolt.Vec3(...torque));
    limp.bodies[0].AddTorque(new Jolt.Vec3(...torque.map((x) => -x)));
  });
});

test('a soft body of Jolt made of a torn mesh follows our skin', async () => {
  const Jolt = await initJolt();
  for (const name of ['tube', 'two_clips']) {
    const model = await Sunder.load(rig(name), { soft: false });
    if (!model.clips.length) continue;
    const scene = await Sunder.createScene(), it = scene.spawn(model);
    it.setMatrices(model.matrices(0, 0.1));  // without the morph targets of the clip, which Jolt does not know
    scene.update(0);
    const positions = it.mesh(0).positions.slice(), reach = (k) => {
      const along = positions.filter((_, i) => i % 3 === k);
      return [Math.min(...along), Math.max(...along)];
    };
    const [x, y, z] = [0, 1, 2].map(reach), size = Math.hypot(...[x, y, z].map(([low, high]) => high - low));
    const at = (t) => [x[0] + 0.47 * (x[1] - x[0]),  /* beside the edges in the middle */ y[0] + t * (y[1] - y[0])];
    it.tear([0.3, 0.5, 0.7].map((t) => [[...at(t), z[1] + size], [...at(t), (z[0] + z[1]) / 2]]));
    scene.update(0);
    assert.ok(scene.results[0].facesCrossed > 0, `${name}: ${scene.results[0].error}, ${JSON.stringify([x, y, z])}`);
    const world = createJoltWorld(Jolt);
    world.GetPhysicsSystem().SetGravity(new Jolt.Vec3(0, -GRAVITY, 0));
    const mesh = it.source(0), skin = model.skins[mesh.skin];
    // One is put onto the skin in each frame, the other one hangs on it by at most a twentieth of its size.
    const tight = addSoftBody(Jolt, world, mesh, skin, 0);
    const loose = addSoftBody(Jolt, world, mesh, skin, 0.05 * size);
    let furthest = 0, sagging = 0;
    for (let frame = 0; frame < 60; ++frame) {
      it.setMatrices(model.matrices(0, 0.1 + frame * FRAME));
      scene.update(FRAME);
      loose.follow(it.matrices, frame === 0);
      world.Step(FRAME, 1);
      tight.follow(it.matrices, true);
      const ours = it.mesh(0).positions, used = new Set(it.source(0).triangles);
      const [hard, soft] = [tight.positions(), loose.positions()];
      for (const v of used) {
        const away = (theirs) => Math.hypot(...[0, 1, 2].map((k) => theirs[3 * v + k] - ours[3 * v + k]));
        furthest = Math.max(furthest, away(hard));
        sagging = Math.max(sagging, away(soft));
      }
    }
    assert.ok(furthest < 1e-5 * size, `${name}: ${furthest / size} of the size`);
    assert.ok(sagging > 1e-4 * size && sagging < 0.055 * size, `${name}: loose by ${sagging / size}`);
  }
});

test('every rig has a ragdoll, and faults are named', async () => {
  for (const name of rigNames) {
    const model = await Sunder.load(rig(name), { soft: false }), ragdoll = model.ragdoll();
    assert.ok(ragdoll.bodies.length >= 1 && ragdoll.bodies.length <= 16, name);
    const places = ragdoll.place(model.matrices());
    ragdoll.bodies.forEach((body, i) => body.modelFromBody.forEach((x, k) => assert.ok(Math.abs(places[12 * i + k] - x) < 1e-6)));
    const back = ragdoll.matrices(places);
    model.matrices().forEach((x, i) => assert.ok(Math.abs(back[i] - x) < 1e-6 * (1 + Math.abs(x))));
    assert.equal(ragdoll.turns(places).length, 4 * ragdoll.bodies.length);
    ragdoll.dispose();
    assert.throws(() => ragdoll.place(model.matrices()), /disposed/);
  }
  const model = await Sunder.load(rig('tube'));
  for (const length of [12, 12 * model.bones.length + 3])
    assert.throws(() => model.ragdoll(new Float64Array(length)), { code: 'invalid_argument' });
  assert.throws(() => model.ragdoll(undefined, { morphWeights: [] }), { code: 'invalid_argument' });
  assert.throws(() => model.ragdoll().place(new Float64Array(3)), { code: 'invalid_argument' });
  assert.throws(() => model.ragdoll().matrices(new Float64Array(3)), { code: 'invalid_argument' });
  assert.throws(() => model.ragdoll(undefined, { maximumBodies: 0 }), { code: 'invalid_argument' });
  assert.throws(() => model.ragdoll(undefined, { limits: [{ bone: 0, kind: 'elbow', axis: [1, 0, 0] }] }), { code: 'invalid_argument' });
  const limits = [{ bone: model.ragdoll().bodies[1].bone, kind: 'hinge', axis: [0, 0, 1], lower: -0.1, upper: 0.2 }];
  const hinge = model.ragdoll(undefined, { limits }).bodies.find(({ bone }) => bone === limits[0].bone);
  assert.deepEqual([hinge?.limit.kind, hinge?.limit.lower, hinge?.limit.upper], ['hinge', -0.1, 0.2]);
});
