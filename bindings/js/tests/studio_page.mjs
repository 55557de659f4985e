// The studio's page in headless Chromium, for tests.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before } from 'node:test';
import { pathToFileURL } from 'node:url';
import { openPage } from './chromium.mjs';
import { packageFolder } from './support.mjs';

export const folder = mkdtempSync(join(tmpdir(), 'sunder-studio-'));
export const file = join(folder, 'index.html');
export const cactus = () => readFileSync(join(packageFolder, 'studio', 'characters', 'cactus.glb'));
before(() => execFileSync(process.execPath, [join(packageFolder, 'studio', 'build.mjs'), file]));
after(() => rmSync(folder, { recursive: true, force: true }));

/** Opens the page from disk, calls back, and expects that nothing failed. */
export async function withStudio(use, { size = { width: 1280, height: 720 }, prepare } = {}) {
  const { page, faults, close } = await openPage({ isOwn: (url) => url === pathToFileURL(file).href, prepare });
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
export const takeFrames = (page) => page.evaluate(() => {
  const { stage, studio } = globalThis.studio;
  stage.renderer.setAnimationLoop(null);
  globalThis.frames = (count, seconds = 1 / 60) => { for (let i = 0; i < count; ++i) studio.frame(seconds); };
  globalThis.eventAt = (x, y, time) => {
    const box = document.getElementById('canvas').getBoundingClientRect();
    return { clientX: box.left + x * box.width, clientY: box.top + y * box.height, timeStamp: 1000 * time };
  };
});
export async function openFile(page, bytes, name) {
  const path = join(folder, name);
  writeFileSync(path, bytes);
  const input = await page.$('#file');
  await input.uploadFile(path);
}
