// Tears, cuts, bores, pieces, undo, logs, files and snapshots through the package, against the laws of the library.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Sunder, SunderError } from 'sunder-tear';
import { Buffers, FRONT_STROKE, rig } from './support.mjs';

async function tube(options) {
  const model = await Sunder.load(rig('tube'), options);
  const scene = await Sunder.createScene();
  return { model, scene, it: scene.spawn(model) };
}

test('a tear without width keeps the area of the surface, and one with width removes what it says', async () => {
  const { scene, it } = await tube({ soft: false });
  scene.update(0);
  const buffers = new Buffers(), whole = buffers.update(it).area;
  const command = it.tear(FRONT_STROKE);
  assert.equal(command.result, null);
  const [result] = scene.update(0);
  assert.equal(result, command.result);
  assert.equal(await command.done, result);
  assert.ok(result.facesCrossed > 5 && result.verticesAdded > 0 && result.error === null);
  assert.ok(Math.abs(result.length - 1.1) < 0.1, `length ${result.length}`);
  assert.ok(Math.abs(buffers.update(it).area - whole) < 1e-5 * whole);
  it.undo();
  it.tear(FRONT_STROKE, { width: 0.05 });
  const gap = scene.update(0)[1];
  const removed = whole - buffers.update(it).area;
  assert.ok(Math.abs(removed - gap.areaRemoved) < 1e-4, `${removed} and ${gap.areaRemoved}`);
  assert.ok(Math.abs(removed - 0.05 * gap.length) < 0.1 * removed);
});

test('typed arrays, objects and nested arrays of a stroke are the same tear', async () => {
  const digests = [];
  for (const stroke of [FRONT_STROKE, Float64Array.from(FRONT_STROKE.flat(2)),
    FRONT_STROKE.map(([[x, y, z], tip]) => ({ base: { x, y, z }, tip: Float64Array.from(tip) }))]) {
    const { scene, it } = await tube();
    it.tear(stroke);
    scene.update(0);
    digests.push(it.digest);
  }
  assert.notEqual(digests[0], 0n);
  assert.deepEqual(new Set(digests).size, 1);
});

test('undo and redo go there and back, a log and a file make the same model again', async () => {
  const { model, scene, it } = await tube();
  const before = it.toGLB();
  it.tear(FRONT_STROKE, { width: 0.02, wallDepth: 0.1 });
  it.drill({ origin: [0, 1, -2], direction: [0, 0, 1], radius: 0.1, depth: 1.8, wall: true });
  scene.update(1 / 60);
  assert.ok(scene.results.every((result) => result.error === null));
  const torn = it.digest;
  assert.deepEqual(it.undoCounts, { undo: 2, redo: 0 });
  it.undo();
  it.undo();
  scene.update(1 / 60);
  assert.deepEqual(it.toGLB(), before);
  it.redo();
  it.redo();
  scene.update(1 / 60);
  assert.equal(it.digest, torn);

  const other = scene.spawn(model);
  assert.equal(other.applyLog(it.log), 2);
  assert.equal(other.digest, torn);
  const saved = await Sunder.load(it.toGLB());
  assert.ok(saved.mesh(0).vertexCount > model.mesh(0).vertexCount);
  assert.ok(saved.mesh(0).submeshes.length > model.mesh(0).submeshes.length);
});

test('a weld closes a wound, a bit of it or all, and can be undone', async () => {
  const { model, scene, it } = await tube();
  it.tear(FRONT_STROKE);
  const [torn] = scene.update(0);
  const open = it.digest;
  it.weld({ places: [FRONT_STROKE[0][1]], reach: 0.1 });
  const [bit] = scene.update(0);
  assert.ok(bit.error === null && bit.length > 0 && bit.length < 0.9 * torn.length, `${bit.length} of ${torn.length}`);
  it.weld();
  const [rest] = scene.update(0);
  assert.ok(Math.abs(bit.length + rest.length - torn.length) < 0.02 * torn.length, `${rest.length}`);
  const closed = it.digest, other = scene.spawn(model);
  assert.equal(other.applyLog(it.log), 3);
  assert.equal(other.digest, closed);
  it.undo();
  it.undo();
  scene.update(0);
  assert.equal(it.digest, open);
  it.suture({ spacing: 0.05, strength: 10 });
  assert.ok(scene.update(0)[0].runs > 0 && it.log.includes('"suture"') && it.digest !== open);
  const { threads } = it;
  assert.ok(threads.length > 1);
  for (const { left, right, newtons, isBroken } of threads)
    assert.ok(left.mesh === right.mesh && left.vertex !== right.vertex && newtons >= 0 && !isBroken);
  it.undo();
  scene.update(0);
  assert.equal(it.threads.length, 0);
  assert.equal(it.digest, open);
  it.suture({ stiffness: 0 });
  assert.match(scene.update(0)[0].error.message, /stiffness is 0 N\/m/);
  assert.throws(() => it.weld({ places: [] }), { code: 'invalid_argument' });
  it.weld({ places: [[0, NaN, 0]] });
  assert.equal(scene.update(0)[0].error.code, 'non_finite_value');
  assert.equal(it.digest, open);
});

test('a cut severs, a detach takes the piece off, which is a model with mass', async () => {
  const { scene, it } = await tube();
  it.cut({ point: [0, 1.2, 0], normal: { x: 0, y: 1, z: 0 }, caps: true });
  const [cut] = scene.update(1 / 60);
  assert.ok(cut.separatedPieces >= 1 && cut.caps >= 1);
  it.detach({ point: [0, 2, 0], density: 1000 });
  const [{ piece }] = scene.update(1 / 60);
  const { volume, mass, solid } = piece.info;
  // A prism over a regular polygon of 24 sides: within a tenth of the cylinder.
  assert.ok(Math.abs(volume - 0.8 * Math.PI * 0.25) < 0.08, `volume ${volume}`);
  assert.ok(Math.abs(mass - 1000 * volume) < 1e-6 * mass && solid === 'closed');
  const fallen = scene.spawn(piece.toModel());
  fallen.inheritMotion(piece);
  scene.update(1 / 60);
  assert.equal(piece.source(0).vertices.length, fallen.model.mesh(0).vertexCount);
  assert.throws(() => piece.hulls(), { code: 'unsupported_feature' });
  piece.dispose();
  assert.throws(() => piece.info, { code: 'invalid_handle' });
});

test('a stroke over several frames tears as one tear does', async () => {
  const { scene, it } = await tube({ soft: false });
  const stroke = it.beginStroke(FRONT_STROKE[0]);
  scene.update(1 / 60);
  for (const position of FRONT_STROKE.slice(1)) {
    stroke.extend(position, 1 / 60);
    scene.update(1 / 60);
  }
  stroke.end();
  scene.update(1 / 60);
  const { scene: other, it: whole } = await tube({ soft: false });
  whole.tear(FRONT_STROKE);
  const [result] = other.update(1 / 60);
  assert.ok(Math.abs(it.mesh().vertexCount - whole.mesh().vertexCount) <= 4);
  assert.ok(result.runs === 1);
});

test('held tissue follows its hold, a wound under tension gapes, and both come to rest', async () => {
  const { scene, it } = await tube({ soft: 'skin', tension: 40 });
  it.tear(FRONT_STROKE);
  scene.update(1 / 60);
  const contact = it.raycast([0.2, 1, 2], [0, 0, -1]);
  assert.ok(contact && Math.abs(contact.place[2] - Math.sqrt(0.25 - 0.04)) < 0.02, JSON.stringify(contact));
  const target = [contact.place[0] + 0.2, contact.place[1], contact.place[2] + 0.1];
  const hold = it.hold(contact, target);
  const before = it.mesh().positions.slice();
  for (let i = 0; i < 60; ++i) scene.update(1 / 60);
  const moved = it.mesh().positions.reduce((most, value, i) => Math.max(most, Math.abs(value - before[i])), 0);
  assert.ok(moved > 0.05, `moved by ${moved}`);
  hold.release();
  assert.throws(() => hold.move(target), SunderError);
  it.setTension(0);
  for (let i = 0; i < 1200 && it.tissue.isAwake; ++i) scene.update(1 / 60);
  assert.equal(it.tissue.isAwake, false);
});

test('pulled tissue gives way where it is weak, and each tear can be undone', async () => {
  const { scene, it } = await tube({ soft: 'skin' });
  it.prepareToTear();
  scene.update(1 / 60);
  it.setMaterial({ base: 'skin', strength: 1.05 });
  const { place, ...contact } = it.raycast([0.2, 1, 2], [0, 0, -1]);
  it.hold(contact, [2 * place[0], place[1], 2 * place[2]], { stiffness: 1e5 });
  const whole = it.digest;
  let tears = 0;
  for (let i = 0; i < 60; ++i) {
    scene.update(1 / 60);
    const found = it.tearOverstretched({ length: 1 });
    assert.ok(found.greatestStretch >= 1);
    assert.equal(found.hasTorn, found.length > 0);
    tears += found.hasTorn;
  }
  assert.ok(tears > 0);
  for (let i = 0; i < tears; ++i) it.undo();
  scene.update(1 / 60);
  assert.equal(it.digest, whole);
  assert.throws(() => it.tearOverstretched({ length: -1 }), { code: 'invalid_argument' });
});

test('a snapshot goes on with the same bits, in its scene and in another one', async () => {
  const { model, scene, it } = await tube({ tension: 5 });
  it.play('Bend');
  scene.update(0.3);
  it.tear(FRONT_STROKE, { width: 0.01 });
  for (let i = 0; i < 10; ++i) scene.update(1 / 60);
  const snapshot = scene.save(), { id } = it;
  const goOn = (target, instance) => {
    for (let i = 0; i < 20; ++i) target.update(1 / 60);
    return instance.mesh().positions.slice();
  };
  const first = goOn(scene, it);
  scene.restore(snapshot, [model]);
  assert.deepEqual(goOn(scene, it), first);
  const other = await Sunder.createScene();
  other.restore(snapshot, [model]);
  assert.deepEqual(goOn(other, other.adopt(id, model)), first);
  const broken = snapshot.slice();
  broken[broken.length >> 1] ^= 1;
  assert.throws(() => other.restore(broken, [model]), SunderError);
});

test('clips play, layers fade, poses are set and read', async () => {
  const { model, scene, it } = await tube();
  assert.deepEqual(model.clips.map(({ name }) => name), ['Bend']);
  const layer = it.play('Bend', { mode: 'once' });
  scene.update(0.5);
  assert.ok(Math.abs(layer.state.time - 0.5) < 1e-12);
  assert.deepEqual(it.matrices, model.matrices('Bend', 0.5));
  it.stop();
  const rest = model.matrices();
  it.setMatrices(rest);
  scene.update(0);
  assert.deepEqual(it.matrices, rest);
  assert.equal(model.bones[model.bone('bone1')].parent, model.bone('bone0'));
});

/** A square metre of 16 x 16 cells in the plane z = 0, as arrays. */
function sheetArrays(n = 16) {
  const positions = [], triangles = [];
  for (let y = 0; y <= n; ++y) for (let x = 0; x <= n; ++x) positions.push(x / n, y / n, 0);
  for (let y = 0; y < n; ++y) {
    for (let x = 0; x < n; ++x) {
      const a = y * (n + 1) + x;
      triangles.push(a, a + 1, a + n + 2, a, a + n + 2, a + n + 1);
    }
  }
  return { meshes: [{ positions, triangles }] };
}

test('a model from arrays is torn like one from a file', async () => {
  const model = await Sunder.fromArrays(sheetArrays(), { soft: false });
  const scene = await Sunder.createScene();
  const sheet = scene.spawn(model);
  sheet.tear([[[0.21, 0.33, 1], [0.21, 0.33, -1]], [[0.83, 0.67, 1], [0.83, 0.67, -1]]]);
  const [{ length }] = scene.update(0);
  assert.ok(Math.abs(length - Math.hypot(0.62, 0.34)) < 1e-6, `${length}`);
});

/** How far the tissue beside a slit in the middle moves at most, to the left and to the right, after a second. */
async function gapes(options) {
  const scene = await Sunder.createScene(), sheet = scene.spawn(await Sunder.fromArrays(sheetArrays(), { soft: 'skin', tension: 5, ...options }));
  sheet.prepareToTear();
  scene.update(0);
  sheet.tear([[[0.3, 0.52, 1], [0.3, 0.52, -1]], [[0.7, 0.52, 1], [0.7, 0.52, -1]]]);
  scene.update(0);
  const before = sheet.mesh().positions.slice();
  for (let i = 0; i < 30; ++i) scene.update(1 / 30);
  const after = sheet.mesh().positions, most = { left: 0, right: 0 };
  for (let v = 0; v < before.length; v += 3) {
    const moved = Math.hypot(after[v] - before[v], after[v + 1] - before[v + 1], after[v + 2] - before[v + 2]), side = before[v] < 0.5 ? 'left' : 'right';
    most[side] = Math.max(most[side], moved);
  }
  return most;
}

test('tissue moves less where factors make it stiff, and factors of one change nothing', async () => {
  const x = sheetArrays().meshes[0].positions.filter((_, i) => i % 3 === 0);
  const plain = await gapes({}), ones = await gapes({ fields: [{ field: 'stiffness', values: x.map(() => 1) }] });
  assert.deepEqual(ones, plain);
  const stiff = await gapes({ fields: [{ mesh: 0, field: 'stiffness', values: Float32Array.from(x, (at) => (at > 0.5 ? 8 : 1)) }] });
  assert.ok(stiff.right < 0.8 * stiff.left && stiff.right < 0.8 * plain.right, JSON.stringify({ plain, stiff }));
});

test('attributes that are added are in files, also beside those that a file had', async () => {
  const plain = await Sunder.fromArrays(sheetArrays(), { soft: false }), values = Float32Array.from({ length: 289 }, (_, i) => 1 + i / 100);
  const first = plain.withAttributes([{ name: '_TENSION', values: new Float32Array(289) }, { name: '_TENSION', values }], { soft: false });
  const read = await Sunder.load(first.toGLB(), { soft: false });
  const second = await Sunder.load(read.withAttributes([{ mesh: 0, name: '_STRENGTH', values }], { soft: false }).toGLB(), { soft: false });
  const found = Object.fromEntries(second.mesh(0).attributes.map((one) => [one.name, Array.from(one.values)]));
  assert.deepEqual(found, { _TENSION: Array.from(values), _STRENGTH: Array.from(values) });
  assert.deepEqual(plain.mesh(0).attributes, []);
  assert.throws(() => plain.withAttributes([]), /attributes are empty/);
  assert.throws(() => plain.withAttributes([{ name: 'TENSION', values }]), { code: 'invalid_argument' });
  assert.throws(() => plain.withAttributes([{ name: '_TENSION', values: values.slice(1) }]), { code: 'size_mismatch' });
  assert.throws(() => plain.withAttributes([{ mesh: 3, name: '_TENSION', values }]), { code: 'index_out_of_range' });
});

test('fields and perforations that do not fit are told', async () => {
  const make = (options) => Sunder.fromArrays(sheetArrays(), options), values = new Float32Array(289).fill(1);
  await assert.rejects(make({ fields: [{ field: 'stiffness', values: [1, 2] }] }), { code: 'size_mismatch', message: /2 values; the mesh has 289/ });
  await assert.rejects(make({ fields: [{ field: 'hardness', values }] }), /none of strength, toughness/);
  await assert.rejects(make({ fields: [{ field: 'stiffness' }] }), SunderError);
  await assert.rejects(make({ fields: [{ mesh: 1, field: 'stiffness', values }] }), { code: 'index_out_of_range' });
  const places = [{ triangle: 0, barycentric: [1, 0, 0] }, { mesh: 0, triangle: 9, barycentric: [0, 0.5, 0.5] }];
  await assert.rejects(make({ perforations: [{ places, strength: 2 }] }), { code: 'invalid_argument', message: /strength of perforation 0 is 2/ });
  await assert.rejects(make({ perforations: [{ places: [places[0], { triangle: 9, barycentric: [1, 0] }], strength: 0.5 }] }), /barycentric of a place/);
  await assert.rejects(make({ perforations: [{ places: places.slice(1), strength: 0.5 }] }), /perforation 0 has 1 places/);
  (await make({ perforations: [{ places, strength: 0.5 }], fields: [{ field: 'toughness', values }] })).dispose();
});

test('errors have a code, an index and a text; wrong options are told', async () => {
  await assert.rejects(Sunder.load(new Uint8Array([1, 2, 3])), (error) => error instanceof SunderError && error.code !== '' && error.message.length > 5);
  const { scene, it } = await tube();
  assert.throws(() => it.tear(FRONT_STROKE, { walldepth: 1 }), /'walldepth' is no option; there are .*wallDepth/);
  assert.throws(() => it.tear(FRONT_STROKE, { layers: 'some' }), /none of nearest, all/);
  assert.throws(() => it.tear([[[0, 0], [0, 0, 1]]]), { code: 'invalid_argument' });
  assert.throws(() => it.play('Dance'), { code: 'not_found' });
  const failing = it.tear([[[NaN, 0, 0], [0, 0, 1]], [[0, 0, 0], [0, 1, 1]]]);
  const [result] = scene.update(0);
  assert.equal(result.error.code, 'non_finite_value');
  await assert.rejects(failing.done, { code: 'non_finite_value' });
  const log = JSON.parse(it.log);
  assert.deepEqual(log.operations ?? [], []);
});
