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
