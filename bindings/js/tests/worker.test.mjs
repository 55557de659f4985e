// The package in a worker: the same bits as outside.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Worker, isMainThread, parentPort } from 'node:worker_threads';
import { FRONT_STROKE, rig } from './support.mjs';

async function digest() {
  const { Sunder } = await import('sunder-tear');
  const model = await Sunder.load(rig('tube'));
  const scene = await Sunder.createScene();
  const it = scene.spawn(model);
  it.tear(FRONT_STROKE, { width: 0.01 });
  scene.update(0);
  return it.digest;
}

if (!isMainThread) {
  parentPort.postMessage(await digest());
} else {
  test('a worker tears', async () => {
    const worker = new Worker(new URL(import.meta.url));
    const answer = await new Promise((resolve, reject) => worker.once('message', resolve).once('error', reject));
    await worker.terminate();
    assert.equal(answer, await digest());
    assert.notEqual(answer, 0n);
  });
  test('the entry with the library beside it tears alike', async () => {
    const { Sunder } = await import('sunder-tear/wasm');
    const model = await Sunder.load(rig('tube'));
    const scene = await Sunder.createScene();
    const it = scene.spawn(model);
    it.tear(FRONT_STROKE, { width: 0.01 });
    scene.update(0);
    assert.equal(it.digest, await digest());
  });
}
