// The studio in headless Chromium: what its tools do on characters that move, and what its files say.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test, { after, before } from 'node:test';
import { pathToFileURL } from 'node:url';
import { Sunder } from 'sunder-tear';
import { fleshPixels, needsChromium, openPage } from './chromium.mjs';
import { packageFolder, rig, sharedRigs } from './support.mjs';

const folder = mkdtempSync(join(tmpdir(), 'sunder-studio-'));
const file = join(folder, 'index.html');
const cactus = () => readFileSync(join(packageFolder, 'studio', 'characters', 'cactus.glb'));
before(() => execFileSync(process.execPath, [join(packageFolder, 'studio', 'build.mjs'), file]));
after(() => rmSync(folder, { recursive: true, force: true }));

/** Opens the page from disk, calls back, and expects that nothing failed. */
async function withStudio(use, size = { width: 1280, height: 720 }) {
  const { page, faults, close } = await openPage({ isOwn: (url) => url === pathToFileURL(file).href });
  try {
    await page.setViewport(size);
    await page.goto(pathToFileURL(file).href);
    await page.waitForSelector('body[data-operations]');
    await use(page);
    assert.deepEqual(faults, []);
    assert.equal(await page.$eval('#error', (element) => element.textContent), '');
  } finally {
    await close();
  }
}
/** Lets tests make the frames, so that they do not depend on how fast the machine draws. */
const takeFrames = (page) => page.evaluate(() => {
  const { stage, studio } = globalThis.studio;
  stage.renderer.setAnimationLoop(null);
  globalThis.frames = (count, seconds = 1 / 60) => { for (let i = 0; i < count; ++i) studio.frame(seconds); };
  globalThis.eventAt = (x, y, time) => {
    const box = document.getElementById('canvas').getBoundingClientRect();
    return { clientX: box.left + x * box.width, clientY: box.top + y * box.height, timeStamp: 1000 * time };
  };
});
async function openFile(page, bytes, name) {
  const path = join(folder, name);
  writeFileSync(path, bytes);
  const input = await page.$('#file');
  await input.uploadFile(path);
}
const said = (page) => page.$eval('#said', (element) => element.textContent);

test('a drag tears the moving character; undo closes it', needsChromium, async () => withStudio(async (page) => {
  const clean = await fleshPixels(page);
  await page.mouse.move(430, 250);
  await page.mouse.down();
  for (let i = 1; i <= 12; ++i) {
    await page.mouse.move(430 + 2 * i, 250 + 10 * i);
    await page.evaluate(() => new Promise(requestAnimationFrame));
  }
  await page.mouse.up();
  await page.waitForSelector('body[data-operations="1"]');
  await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 1500)));
  assert.ok(await fleshPixels(page) > clean + 500, 'the wound gapes');
  assert.equal(await page.$$eval('#history li', (items) => items.length), 1);
  await page.keyboard.press('z');
  await page.waitForSelector('body[data-operations="0"]');
  await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 500)));
  assert.ok(await fleshPixels(page) <= clean + 20);
}));

/** What the command says of the same log, where it is built. */
function digestOfCommand(log) {
  const command = process.env.SUNDER_COMMAND ?? join(packageFolder, '..', '..', 'build', 'release', 'tools', 'sunder');
  if (!existsSync(command)) return null;
  const at = (name) => join(folder, name);
  writeFileSync(at('cactus.glb'), cactus());
  writeFileSync(at('ops.json'), log);
  execFileSync(command, ['tear', at('cactus.glb'), '--ops', at('ops.json'), '-o', at('torn.glb'), '--report', at('report.json'), '-q']);
  return JSON.parse(readFileSync(at('report.json'), 'utf8'));
}

test('200 random actions leave no error, and their log makes the same model elsewhere', needsChromium, async (t) => withStudio(async (page) => {
  await takeFrames(page);
  const { log, digest, done, operations } = await page.evaluate(() => {
    const { studio, settings, tools } = globalThis.studio;
    let seed = 11, now = 0;
    const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
    const done = {};
    for (let i = 0; i < 200; ++i) {
      const choice = Math.floor(random() * 9);
      Object.assign(settings, { width: random() < 0.5 ? 0 : 0.01 * random(), depth: 0.02 + 0.08 * random(), radius: 0.01 + 0.02 * random() });
      if (choice < 6) {
        const tool = tools[choice];
        let x = 0.25 + 0.5 * random(), y = 0.1 + 0.8 * random();
        if (studio.begin(tool, eventAt(x, y, now))) {
          const dx = 0.03 * (random() - 0.5), dy = 0.03 * (random() - 0.5);
          for (let step = 0; step < 8; ++step) {
            now += 0.02;
            studio.move(eventAt(x += dx, y += dy, now));
            frames(1);
          }
          studio.end();
          done[tool.name] = (done[tool.name] ?? 0) + 1;
        }
      } else if (choice === 6) studio.undo();
      else if (choice === 7) studio.redo();
      else studio.speed = random();
      frames(2);
    }
    frames(3);
    const { instance } = studio.actor;
    return { log: instance.log, digest: String(instance.digest), done, operations: instance.undoCounts.undo };
  });
  t.diagnostic(`${JSON.stringify(done)}; ${operations} operations are left`);
  assert.equal(Object.keys(done).length, 5, 'each tool took a drag');
  assert.ok(operations > 5);
  const scene = await Sunder.createScene(), it = scene.spawn(await Sunder.load(cactus(), { soft: 'skin' }));
  assert.equal(it.applyLog(log), operations);
  assert.equal(String(it.digest), digest);
  const report = digestOfCommand(log);
  if (report) assert.ok(JSON.stringify(report).includes(BigInt(digest).toString(16).padStart(16, '0')), 'natively');
}));

test('memory stays as it is over tears that are undone', needsChromium, async () => withStudio(async (page) => {
  await takeFrames(page);
  const sizes = await page.evaluate(() => {
    const { studio, tools } = globalThis.studio, sizes = [];
    for (let i = 0; i < 300; ++i) {
      const x = 0.44 + 0.04 * Math.sin(i), y = 0.3 + 0.1 * Math.cos(i);
      studio.begin(tools[1], eventAt(x, y, i));
      frames(1);
      studio.move(eventAt(x, y + 0.1, i + 0.5));
      studio.end();
      frames(1);
      studio.goBackTo(0);
      frames(1);
      if (i % 100 === 99) sizes.push(studio.actor.tissue.calls.memory.buffer.byteLength);
    }
    return sizes;
  });
  assert.equal(sizes[2], sizes[0]);
}));

test('a telephone shows all of it without scrolling sideways', needsChromium, async () => withStudio(async (page) => {
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  const height = await page.$eval('#canvas', (canvas) => canvas.getBoundingClientRect().height);
  assert.ok(height > 300, `${height} pixels for the character`);
}, { width: 390, height: 844, hasTouch: true, isMobile: true }));
