// The wounds in the texture of a mesh, kept in step while a scene plays.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Sunder, SunderError } from 'sunder-tear';
import { FRONT_STROKE, rig } from './support.mjs';

test('rectangles make the whole texture, and undo takes the wound out of it', async () => {
  const scene = await Sunder.createScene(), it = scene.spawn(await Sunder.load(rig('tube'), { soft: false }));
  scene.update(0);
  assert.throws(() => it.woundMask(), SunderError);
  assert.throws(() => it.beginWoundMask({ reach: -1 }), SunderError);
  assert.throws(() => it.beginWoundMask({ glow: 1 }), /reach/);
  it.beginWoundMask({ width: 128, height: 64, reach: 0.2 });
  const first = it.woundMask(), texture = first.distances.slice(), reach = Math.fround(0.2);
  assert.deepEqual(first.changed, { left: 0, top: 0, width: 128, height: 64 });
  assert.ok(texture.every((distance) => distance === reach));
  const follow = () => {
    const { changed, distances, width } = it.woundMask();
    for (let row = changed.top; row < changed.top + changed.height; ++row)
      texture.set(distances.subarray(row * width + changed.left, row * width + changed.left + changed.width), row * width + changed.left);
    assert.deepEqual(texture, distances);
    return changed;
  };
  it.tear(FRONT_STROKE, { width: 0.05 });
  scene.update(1 / 60);
  const changed = follow();
  assert.ok(changed.width > 0);
  assert.ok(texture.some((distance) => distance < 0) && texture.some((distance) => distance > 0 && distance < 0.1));
  it.undo();
  scene.update(1 / 60);
  follow();
  assert.ok(texture.every((distance) => distance === reach));
  assert.equal(follow().width, 0);
  it.endWoundMask();
  assert.throws(() => it.woundMask(), SunderError);
});

test('channels tell of the nearest lip, and blood runs from it', async () => {
  const scene = await Sunder.createScene(), it = scene.spawn(await Sunder.load(rig('tube'), { soft: false }));
  scene.update(0);
  assert.throws(() => it.woundChannel('age'), { code: 'not_found' });
  it.beginWoundMask({ width: 128, height: 64, reach: 0.1 });
  assert.ok(it.woundChannel('age').every((age) => age === -1));
  it.tear(FRONT_STROKE, { wallDepth: 0.05 });
  scene.update(1 / 60);
  const distances = it.woundMask().distances.slice(), reach = Math.fround(0.1);
  const ages = it.woundChannel('age').slice(), depths = it.woundChannel('depth').slice(), stretches = it.woundChannel('stretch').slice();
  distances.forEach((distance, i) => {
    if (Math.abs(distance) < 0.099) assert.ok(ages[i] === 0 && depths[i] > 0);
    if (distance === reach) assert.ok(ages[i] === -1 && depths[i] === 0 && stretches[i] === 1);
  });
  assert.ok(ages.includes(0) && ages.includes(-1));
  const blood = it.flowBlood({ down: { x: 0, y: -1, z: 0 }, length: 0.3, width: 0.02, spacing: 0.02, seed: 3 });
  assert.equal(blood.length, 128 * 64);
  assert.ok(blood.every((one) => one >= 0 && one <= 1) && blood.some((one) => one > 0));
  assert.throws(() => it.flowBlood({ width: -1 }), { code: 'invalid_argument' });
  assert.throws(() => it.woundChannel('heat'), /no channel; there are age, depth, stretch/);
  it.beginWoundMask({ width: 128, height: 64, reach: 0.1, firstOperation: 1 });
  assert.ok(it.woundMask().distances.every((distance) => distance === reach), 'there is no operation after the first');
});
