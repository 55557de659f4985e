// Numbers that a memory of 32 bits cannot hold, or that wrap to small ones in it: refused with an error, and the library goes on.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Sunder, SunderError } from 'sunder-tear';
import { characterData } from '../src/character_arrays.js';
import { FRONT_STROKE, rig } from './support.mjs';

const LIMIT_EXCEEDED = 15;
/** 2^30 + 1 times four, or 2^32 / 12 + 1 times twelve, is a small number of 32 bits. */
const HARD = [0x15555556, 0x20000001, 0x40000001, 0x55555556, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF];
const HARDER = [...HARD, 2 ** 32, 2 ** 32 + 1, 2 ** 32 + 24, 2 ** 53 - 1];

/** Whether it is refused; any error but one of the library's own is a failure of the test. */
async function isRefused(call, what) {
  try {
    await call();
    return false;
  } catch (error) {
    assert.ok(error instanceof SunderError, `${what}: ${error}`);
    assert.notEqual(error.code, 'internal_error', `${what}: ${error.message}`);
    return true;
  }
}

async function goesOn() {
  const scene = await Sunder.createScene(), it = scene.spawn(await Sunder.load(rig('tube')));
  it.tear(FRONT_STROKE);
  assert.equal(scene.update(0)[0].error, null);
  scene.dispose();
}

test('sizes of bytes beyond 32 bits are refused', async () => {
  await Sunder.init();
  const { calls } = Sunder, m = calls.memory, mark = m.mark(), glb = rig('tube');
  const scene = await Sunder.createScene(), it = scene.spawn(await Sunder.load(glb));
  const at = m.array(Uint8Array, glb), out = m.room(8), size = 2n ** 32n + BigInt(glb.length);
  assert.equal(calls.exports.sunder_load_glb(at, size, 0, out), LIMIT_EXCEEDED);
  assert.equal(calls.exports.sunder_apply_log(scene.handle, it.id, at, size, out), LIMIT_EXCEEDED);
  assert.equal(calls.exports.sunder_restore_scene(scene.handle, at, size, 0, 0, 0), LIMIT_EXCEEDED);
  m.release(mark);
  await goesOn();
});

test('arrays that no memory holds are refused', async () => {
  await Sunder.init();
  const { calls } = Sunder, simple = () => characterData({ positions: [0, 0, 0, 1, 0, 0, 0, 1, 0] });
  for (const count of HARD) {
    for (const field of ['vertex_count', 'triangle_count']) {
      const data = simple();
      data.meshes[0][field] = count;
      assert.ok(await isRefused(() => calls.sunder_create_character(data), `${field} ${count}`));
    }
    const data = simple();
    data.skins[0].slot_count = count;
    assert.ok(await isRefused(() => calls.sunder_create_character(data), `slot_count ${count}`));
  }
  await goesOn();
});

/** All numbers of a document, as functions that set them. */
function numbersIn(value, path = '') {
  return Object.entries(value).flatMap(([key, one]) => {
    if (typeof one === 'number') return [{ path: `${path}/${key}`, set: (number) => { value[key] = number; }, one }];
    return one && typeof one === 'object' ? numbersIn(one, `${path}/${key}`) : [];
  });
}

function glbOf(document, rest) {
  const json = new TextEncoder().encode(JSON.stringify(document));
  const padded = new Uint8Array(Math.ceil(json.length / 4) * 4).fill(0x20);
  padded.set(json);
  const glb = new Uint8Array(20 + padded.length + rest.length), view = new DataView(glb.buffer);
  [0x46546C67, 2, glb.length, padded.length, 0x4E4F534A].forEach((word, i) => view.setUint32(4 * i, word, true));
  glb.set(padded, 20);
  glb.set(rest, 20 + padded.length);
  return glb;
}

test('numbers of a GLB that wrap in 32 bits are refused', async () => {
  const glb = rig('tube'), length = new DataView(glb.buffer, glb.byteOffset).getUint32(12, true);
  const document = JSON.parse(new TextDecoder().decode(glb.subarray(20, 20 + length))), rest = glb.subarray(20 + length);
  const { accessors, bufferViews, buffers, skins } = document;
  let refused = 0;
  for (const { path, set, one } of numbersIn({ accessors, bufferViews, buffers, skins })) {
    if (/\/(min|max)\//.test(path)) continue;
    for (const number of HARDER) {
      set(number);
      refused += await isRefused(() => Sunder.load(glbOf(document, rest)), `${path} ${number}`);
    }
    set(one);
  }
  assert.ok(refused > 200, `${refused}`);
  assert.equal(await isRefused(() => Sunder.load(glbOf(document, rest)), 'as it was'), false);
  await goesOn();
});

test('counts of a snapshot that wrap in 32 bits are refused', { timeout: 600000 }, async () => {
  const model = await Sunder.load(rig('tube')), scene = await Sunder.createScene(), it = scene.spawn(model);
  it.tear(FRONT_STROKE, { width: 0.01 });
  scene.update(1 / 60);
  const snapshot = scene.save();
  for (let at = 0; at + 4 <= Math.min(snapshot.length, 3000); ++at) {
    const damaged = snapshot.slice(), number = HARD[at % HARD.length];
    new DataView(damaged.buffer).setUint32(at, number, true);
    await isRefused(() => scene.restore(damaged, [model]), `${at}: ${number}`);
  }
  await goesOn();
});
