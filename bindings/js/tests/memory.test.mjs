// The memory of the library grows and moves: no view shows what it is not, and what is disposed of is given back.
import assert from 'node:assert/strict';
import test from 'node:test';
import v8 from 'node:v8';
import vm from 'node:vm';
import { Sunder } from 'sunder-tear';
import { FRONT_STROKE, rig } from './support.mjs';

async function tube(options) {
  const model = await Sunder.load(rig('tube'), options);
  const scene = await Sunder.createScene();
  return { model, scene, it: scene.spawn(model) };
}
const grow = () => Sunder.calls.exports.memory.grow(16);

test('views of before an update are empty after it, and their mesh refuses to be read', async () => {
  const { scene, it } = await tube();
  scene.update(0);
  const mesh = it.mesh(), { positions } = mesh;
  assert.equal(positions.length, 3 * mesh.vertexCount);
  scene.update(1 / 60);
  assert.equal(positions.length, 0);
  assert.throws(() => mesh.positions, { code: 'invalid_handle' });
  assert.ok(it.mesh().positions.length > 0);
});

test('growth within a frame empties arrays, and the mesh gives them anew', async () => {
  const { scene, it } = await tube();
  scene.update(0);
  const mesh = it.mesh(), kept = mesh.positions, copy = kept.slice();
  grow();
  assert.equal(kept.length, 0);
  assert.deepEqual(mesh.positions, copy);
  const source = it.source(), uvs = source.uvSets[0].slice();
  grow();
  assert.deepEqual(source.uvSets[0], uvs);
});

test('growth between the arguments of a call does no harm', async () => {
  const { scene, it } = await tube();
  const { memory } = Sunder.calls, room = memory.room.bind(memory);
  memory.room = (size) => {
    grow();
    return room(size);
  };
  try {
    it.tear(FRONT_STROKE, { width: 0.01 });
    assert.equal(scene.update(0)[0].error, null);
    assert.ok(it.log.includes('stroke') || it.log.length > 50);
  } finally {
    delete memory.room;
  }
});

test('a thousand tears with undo take no more memory than fifty', { timeout: 600000 }, async () => {
  const { scene, it } = await tube({ soft: false });
  const many = (count) => {
    for (let i = 0; i < count; ++i) {
      it.tear(FRONT_STROKE, { width: 0.01, wallDepth: 0.05 });
      scene.update(1 / 60);
      it.undo();
      scene.update(1 / 60);
    }
    return Sunder.memoryBytes;
  };
  const after = many(50);
  assert.equal(many(950), after);
});

test('models and scenes that are disposed of give their memory back', async () => {
  const once = async () => {
    const { model, scene, it } = await tube();
    it.tear(FRONT_STROKE);
    scene.update(0);
    scene.dispose();
    model.dispose();
    return Sunder.memoryBytes;
  };
  let after = 0;
  for (let i = 0; i < 10; ++i) after = await once();
  for (let i = 0; i < 50; ++i) await once();
  assert.equal(Sunder.memoryBytes, after);
  const { model, scene, it } = await tube();
  model.dispose();
  model.dispose();
  it.tear(FRONT_STROKE);
  assert.equal(scene.update(0)[0].error, null, 'a scene keeps what it needs');
  assert.throws(() => model.name, { code: 'invalid_handle' });
  scene.dispose();
  assert.throws(() => scene.update(0), { code: 'invalid_handle' });
});

test('what nobody refers to is destroyed', async () => {
  v8.setFlagsFromString('--expose-gc');
  const collect = vm.runInNewContext('gc');
  const { calls } = Sunder, destroyed = [], original = calls.sunder_destroy_character;
  calls.sunder_destroy_character = (handle) => {
    destroyed.push(handle);
    return original.call(calls, handle);
  };
  const handle = await (async () => (await Sunder.load(rig('tube'))).handle)();
  for (let i = 0; i < 100 && !destroyed.includes(handle); ++i) {
    collect();
    await new Promise((resolve) => setTimeout(resolve, 10));
  }
  delete calls.sunder_destroy_character;
  assert.ok(destroyed.includes(handle));
});
