// The sample page, from the packed package, in headless Chromium: a drag tears, and nothing comes from elsewhere.
import assert from 'node:assert/strict';
import { execSync } from 'node:child_process';
import { copyFileSync, existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import puppeteer from 'puppeteer-core';
import { addThree, installed, serve } from './packed.mjs';
import { packageFolder, rigFile } from './support.mjs';

const PATIENCE = 240000;  // ms; a busy machine is no failure
const chromium = execSync('command -v chromium || true').toString().trim();
const FLAGS = ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync'];

/** How many pixels of a screenshot a test of colours chooses. */
const count = (page, shot, chosen) => page.evaluate(async (base64, source) => {
  const image = new Image();
  image.src = `data:image/png;base64,${base64}`;
  await image.decode();
  const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height), isChosen = new Function('r', 'g', 'b', `return ${source}`);
  let found = 0;
  for (let i = 0; i < data.length; i += 4) if (isChosen(data[i], data[i + 1], data[i + 2])) ++found;
  return found;
}, shot, chosen);
const FLESH = 'r > 60 && r > 2.2 * g && r > 2.2 * b';

test('the sample page tears where one drags', { skip: chromium === '' && 'chromium is absent', timeout: PATIENCE * 3 }, async (t) => {
  const { folder, remove } = installed();
  addThree(folder);
  copyFileSync(join(folder, 'node_modules', 'sunder-tear', 'sample', 'index.html'), join(folder, 'index.html'));
  copyFileSync(process.env.SUNDER_JS_MODEL ?? rigFile('tube'), join(folder, 'character.glb'));
  const server = await serve(folder);
  const browser = await puppeteer.launch({ executablePath: chromium, args: FLAGS, timeout: PATIENCE, protocolTimeout: PATIENCE });
  try {
    const page = await browser.newPage(), errors = [], elsewhere = [];
    page.setDefaultTimeout(PATIENCE);
    page.on('console', (message) => { if (['error', 'warn'].includes(message.type()) && !/GPU stall|swiftshader/i.test(message.text())) errors.push(message.text()); });
    page.on('pageerror', (error) => errors.push(String(error)));
    page.on('request', (request) => { if (!request.url().startsWith(server.address) && !/^(data|blob):/.test(request.url())) elsewhere.push(request.url()); });
    await page.setViewport({ width: 800, height: 600 });
    await page.goto(`${server.address}/index.html`);
    await page.waitForSelector('body[data-torn="0"]');
    const before = await page.screenshot({ encoding: 'base64' });
    await page.mouse.move(420, 230);
    await page.mouse.down();
    for (let i = 1; i <= 12; ++i) {
      await page.mouse.move(420 + (i % 3), 230 + 12 * i);
      await page.evaluate(() => new Promise(requestAnimationFrame));
    }
    await page.mouse.up();
    await page.waitForSelector('body:not([data-torn="0"])');
    await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 500)));
    const after = await page.screenshot({ encoding: 'base64' });
    if (process.env.SUNDER_JS_PICTURE) writeFileSync(process.env.SUNDER_JS_PICTURE, Buffer.from(after, 'base64'));
    const [fleshBefore, fleshAfter] = [await count(page, before, FLESH), await count(page, after, FLESH)];
    t.diagnostic(`${fleshBefore} pixels of flesh before, ${fleshAfter} after`);
    assert.ok(fleshAfter - fleshBefore > 300);
    await page.keyboard.press('z');
    await page.waitForSelector('body[data-torn="0"]');
    await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 300)));
    assert.ok(await count(page, await page.screenshot({ encoding: 'base64' }), FLESH) <= fleshBefore + 20);

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
    assert.deepEqual(errors, []);
    assert.deepEqual(elsewhere, []);
  } finally {
    await browser.close();
    server.close();
    remove();
  }
});

test('the sample page has at most 60 lines', () => {
  const file = join(packageFolder, 'sample', 'index.html');
  assert.ok(existsSync(file) && readFileSync(file, 'utf8').trimEnd().split('\n').length <= 60);
});
