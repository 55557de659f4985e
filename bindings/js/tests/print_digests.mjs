// What tests/c/print_digests.c does, through this package: prints the same lines. print_digests.mjs FOLDER COUNT FILE
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { Sunder, SunderError } from 'sunder-tear';

const FRAME = 1 / 64;

/** A hash of 64 bits by FNV-1a, in two halves; the prime is 2^40 + 0x1b3. */
class Hash {
  low = 0x84222325;
  high = 0xcbf29ce4;
  add(array) {
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    let { low, high } = this;
    for (let i = 0; i < bytes.length; ++i) {
      low = (low ^ bytes[i]) >>> 0;
      const product = low * 0x1b3, below = product % 0x100000000, carry = (product - below) / 0x100000000;
      high = (Math.imul(high, 0x1b3) + carry + (low << 8)) >>> 0;
      low = below;
    }
    Object.assign(this, { low, high });
    return this;
  }
  get value() { return BigInt(this.high) << 32n | BigInt(this.low); }
}

const hex = (value) => BigInt.asUintN(64, value).toString(16).padStart(16, '0');

function hashMeshes(who) {
  const hash = new Hash();
  for (let m = 0; m < who.model.meshCount; ++m) {
    const posed = who.mesh(m);
    hash.add(posed.positions);
    if (posed.normals) hash.add(posed.normals);
  }
  return hash.value;
}

/** A stroke with walls over 8 frames, from side to side through the middle of the model, of which the half is undone; then tissue
 * tears by force. */
function goOn(scene, who) {
  scene.update(FRAME);
  const positions = who.mesh(0).positions, reach = [0, 1, 2].map((k) => [positions[k], positions[k]]);
  positions.forEach((x, i) => { const one = reach[i % 3]; one[0] = Math.min(one[0], x); one[1] = Math.max(one[1], x); });
  const f = Math.fround, low = reach.map(([one]) => one), high = reach.map(([, one]) => one);
  const size = low.map((one, k) => f(high[k] - one)), middle = low.map((one, k) => 0.5 * f(one + high[k]));
  let stroke = null;
  for (let frame = 0; frame < 16; ++frame) {
    const x = low[0] + (0.2 + 0.6 * (frame % 8 / 7)) * size[0];
    const y = middle[1] + (Math.trunc(frame / 8) - 0.5) * 0.3 * size[1];
    const blade = [[x, y, f(high[2] + size[2])], [x, y, middle[2]]];
    if (frame % 8 === 0) stroke = who.beginStroke(blade, { width: 0.01 * size[0], wallDepth: 0.02 * size[0] });
    else stroke.extend(blade, FRAME);
    if (frame % 8 === 7) stroke.end();
    scene.update(FRAME);
  }
  who.undo();
  for (let frame = 0; frame < 8; ++frame) {
    scene.update(FRAME);
    who.tearOverstretched();
  }
  scene.update(FRAME);
}

async function lineOf(folder, number) {
  const soft = { base: 'skin', strength: 1.2 };
  const model = await Sunder.load(new Uint8Array(readFileSync(join(folder, `${number}.glb`))), { soft, tension: 2, gravity: [0, -9.81, 0] });
  const scene = await Sunder.createScene(), again = await Sunder.createScene(), who = scene.spawn(model);
  if (model.clips.length) who.play(0);
  scene.update(0.25);
  let status = 0, applied = 0;
  try {
    applied = who.applyLog(readFileSync(join(folder, `${number}.json`)));
  } catch (error) {
    if (!(error instanceof SunderError)) throw error;
    status = error.status;
    applied = error.index ?? 0;
  }
  scene.update(FRAME);
  const words = [number, status, applied, hex(who.digest), hex(hashMeshes(who))];
  for (let frame = 0; frame < 100; ++frame) scene.update(FRAME);
  const snapshot = scene.save().slice();
  words.push(hex(hashMeshes(who)), hex(new Hash().add(snapshot).value));
  again.restore(snapshot, [model]);
  const restored = again.adopt(who.id, model);
  goOn(again, restored);
  words.push(hex(restored.digest ^ BigInt.asUintN(64, hashMeshes(restored) * 0x9E3779B97F4A7C15n)));
  for (const one of [again, scene, model]) one.dispose();
  return `${words.join(' ')}\n`;
}

const [folder, count, file] = process.argv.slice(2);
let lines = '';
for (let number = 0; number < Number(count); ++number) lines += await lineOf(folder, number);
writeFileSync(file, lines);
