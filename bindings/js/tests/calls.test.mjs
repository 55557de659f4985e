// The generated part: every function is there, and the library accepts every struct that has a size in it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { Sunder } from 'sunder-tear';
import * as generated from '../generated/calls.js';
import { packageFolder } from './support.mjs';

const api = JSON.parse(readFileSync(join(packageFolder, '..', 'c', 'sunder_api.json'), 'utf8'));

test('each function of the header is exported and has a call', async () => {
  await Sunder.init();
  const { calls } = Sunder;
  for (const { name } of api.functions) {
    assert.equal(typeof calls.exports[name], 'function', name);
    assert.equal(typeof calls[name], 'function', name);
  }
});

test('the size in each default struct is that of the generated layout', async () => {
  await Sunder.init();
  const { calls } = Sunder, m = calls.memory;
  for (const struct of Object.values(generated).filter((one) => one?.maker)) {
    const at = m.room(struct.size + 8);
    m.set_u32(at + struct.size, 0xABCDEF01);
    calls.exports[struct.maker](at);
    assert.equal(m.u32(at), struct.size, struct.name);
    assert.equal(m.u32(at + struct.size), 0xABCDEF01, struct.name);
    m.release(m.mark() - 1);
  }
  assert.equal(calls.sunder_default_tear_options().wall_material, generated.SUNDER_NONE);
  assert.equal(calls.sunder_default_layer_options().weight, 1);
});

test('what is written into a struct is read from it, in the same bytes', async () => {
  await Sunder.init();
  const m = Sunder.calls.memory, mark = m.mark();
  for (const struct of api.structs) {
    const layout = generated[struct.name], at = m.room(layout.size);
    let next = 1;
    const number = ({ type, count }) => {
      const one = () => (['sunder_command', 'sunder_instance', 'uint64_t'].includes(type) ? BigInt(next++) : next++);
      return count > 1 ? Array.from({ length: count }, one) : one();
    };
    const plain = struct.fields.filter(({ type }) => !generated[type]);
    const values = Object.fromEntries(plain.map((field) => [field.name, number(field)]));
    m.viewOf(Uint8Array, at, layout.size).fill(0);
    layout.write(m, at, values);
    const read = layout.read(m, at);
    for (const { name } of plain) assert.deepEqual(read[name], values[name], `${struct.name}.${name}`);
    // Bytes past the end of one field belong to no other: all fields together are those written.
    const used = struct.fields.reduce((last, field) => Math.max(last, field.offset32), 0);
    assert.ok(used < layout.size);
  }
  m.release(mark);
});

test('the force on a blade is against its motion, and at most what is asked', async () => {
  await Sunder.init();
  const step = { lengthTorn: 0.01, depth: 0.004, motion: { x: 0.01, y: 0, z: 0 } }, tissue = { toughness: 2000, thickness: 0.002, friction: 20 };
  const [x, y, z] = Sunder.bladeForce(step, tissue);
  assert.ok(Math.abs(x + 4.08) < 1e-12, '2000 J/m^2 over 2 mm, and 20 N/m over 4 mm');
  assert.deepEqual([y + 0, z + 0], [0, 0]);
  assert.deepEqual(Sunder.bladeForce(step, { ...tissue, greatest: 3 })[0], -3);
  assert.throws(() => Sunder.bladeForce({ ...step, lengthTorn: -1 }), /length torn is -1/);
});

test('a default struct is refused if its size is another one', async () => {
  await Sunder.init();
  const { calls } = Sunder, m = calls.memory, mark = m.mark();
  const at = m.room(generated.sunder_scene_options.size), scene = m.room(8);
  calls.exports.sunder_default_scene_options(at);
  m.set_u32(at, generated.sunder_scene_options.size + 4);
  assert.equal(calls.exports.sunder_create_scene(at, scene), generated.SUNDER_INVALID_STRUCT);
  m.release(mark);
});
