// The sample page, from the packed package, in headless Chromium: a drag tears, and nothing comes from elsewhere.
import assert from 'node:assert/strict';
import { copyFileSync, existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { fleshPixels, needsChromium, openPage } from './chromium.mjs';
import { addThree, installed, serve } from './packed.mjs';
import { packageFolder, rigFile } from './support.mjs';

test('the sample page tears where one drags', needsChromium, async (t) => {
  const { folder, remove } = installed();
  addThree(folder);
  copyFileSync(join(folder, 'node_modules', 'sunder-tear', 'sample', 'index.html'), join(folder, 'index.html'));
  copyFileSync(process.env.SUNDER_JS_MODEL ?? rigFile('tube'), join(folder, 'character.glb'));
  const server = await serve(folder);
  const { page, faults, close } = await openPage({ isOwn: (url) => url.startsWith(server.address) });
  try {
    await page.setViewport({ width: 800, height: 600 });
    await page.goto(`${server.address}/index.html`);
    await page.waitForSelector('body[data-torn="0"]');
    const fleshBefore = await fleshPixels(page);
    await page.mouse.move(420, 230);
    await page.mouse.down();
    for (let i = 1; i <= 12; ++i) {
      await page.mouse.move(420 + (i % 3), 230 + 12 * i);
      await page.evaluate(() => new Promise(requestAnimationFrame));
    }
    await page.mouse.up();
    await page.waitForSelector('body:not([data-torn="0"])');
    await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 500)));
    const fleshAfter = await fleshPixels(page);
    t.diagnostic(`${fleshBefore} pixels of flesh before, ${fleshAfter} after`);
    assert.ok(fleshAfter - fleshBefore > 300);
    await page.keyboard.press('z');
    await page.waitForSelector('body[data-torn="0"]');
    await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 300)));
    assert.ok(await fleshPixels(page) <= fleshBefore + 20);

    const answer = await page.evaluate(async () => {
      const program = `import { Sunder } from '${location.origin}/node_modules/sunder-tear/dist/wasm.js';
        const scene = await Sunder.createScene();
        const it = scene.spawn(await Sunder.load(await (await fetch('${location.origin}/character.glb')).arrayBuffer()));
        it.tear([[[0, 1.6, 1], [0, 1.6, 0]], [[0, 0.5, 1], [0, 0.5, 0]]]);
        scene.update(0);
        postMessage(String(it.digest));`;
      const worker = new Worker(URL.createObjectURL(new Blob([program], { type: 'text/javascript' })), { type: 'module' });
      return new Promise((resolve, reject) => {
        worker.onmessage = ({ data }) => resolve(data);
        worker.onerror = reject;
      });
    });
    assert.match(answer, /^\d{5,}$/, 'a worker of the page tears too');
    assert.deepEqual(faults, []);
  } finally {
    await close();
    server.close();
    remove();
  }
});

test('the sample page has at most 60 lines', () => {
  const file = join(packageFolder, 'sample', 'index.html');
  assert.ok(existsSync(file) && readFileSync(file, 'utf8').trimEnd().split('\n').length <= 60);
});
