// Opens a page of `sunder validate --html` in headless Chromium, uses it, and prints what happened
// as JSON. Usage: node validation_page.mjs <page.html> [<picture.png>]
import { execSync } from 'node:child_process';
import { pathToFileURL } from 'node:url';
import puppeteer from 'puppeteer-core';

const [file, picture] = process.argv.slice(2);
const PATIENCE = 240000;  // ms; a busy machine is no failure
const browser = await puppeteer.launch({
  timeout: PATIENCE,
  protocolTimeout: PATIENCE,
  executablePath: execSync('command -v chromium').toString().trim(),
  // Pictures by software: there is no graphics card where tests run.
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
const facts = { errors: [], requests: [] };

/** Opens the page anew. */
async function open(colourScheme = 'light') {
  const page = await browser.newPage();
  page.setDefaultTimeout(PATIENCE);
  await page.setViewport({ width: 1440, height: 900 });
  await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: colourScheme },
    { name: 'prefers-reduced-motion', value: 'reduce' }]);
  page.on('console', (message) => {
    if (message.type() === 'error') facts.errors.push(message.text());
  });
  page.on('pageerror', (error) => facts.errors.push(String(error)));
  page.on('request', (request) => {
    if (!/^(file|data):/.test(request.url())) facts.requests.push(request.url());
  });
  await page.setOfflineMode(true);
  await page.goto(pathToFileURL(file).href);
  await page.waitForSelector('[data-ready=true]');
  await settle(page);
  return page;
}

/** Waits for the picture that was asked for last. */
const settle = (page) => page.evaluate(() => new Promise((resolve) => {
  requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(resolve)));
}));

/** Per viewport: the rectangle of pixels that are not background, in CSS pixels, and their share. */
const drawn = (page) => page.evaluate(() => {
  const { stage } = sunder;
  stage.draw();
  const gl = stage.renderer.getContext();
  const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
  const pixels = new Uint8Array(width * height * 4);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const scale = width / stage.canvas.clientWidth;
  return stage.views.map((_, view) => {
    const half = width / stage.views.length;
    const box = { left: Infinity, right: -Infinity, top: Infinity, bottom: -Infinity };
    let count = 0;
    for (let y = 0; y < height; ++y)
      for (let x = Math.ceil(view * half); x < Math.floor((view + 1) * half); ++x) {
        const i = (y * width + x) * 4;
        const differs = [0, 1, 2].some((k) => Math.abs(pixels[i + k] - pixels[k]) > 6);
        if (!differs) continue;
        ++count;
        box.left = Math.min(box.left, x / scale);
        box.right = Math.max(box.right, (x + 1) / scale);
        box.top = Math.min(box.top, (height - 1 - y) / scale);
        box.bottom = Math.max(box.bottom, (height - y) / scale);
      }
    return { ...box, share: count / (half * height) };
  });
});

/** The same rectangles from positions posed on the CPU. */
const expected = (page) => page.evaluate(() => {
  const { stage, models } = sunder;
  return models.viewports().map(([shown], view) => {
    const positions = shown.positions();
    const box = { left: Infinity, right: -Infinity, top: Infinity, bottom: -Infinity };
    for (const index of shown.model.indices) {
      const place = stage.placeOf(positions.subarray(index * 3, index * 3 + 3), view);
      if (!place) continue;
      box.left = Math.min(box.left, place[0]);
      box.right = Math.max(box.right, place[0]);
      box.top = Math.min(box.top, place[1]);
      box.bottom = Math.max(box.bottom, place[1]);
    }
    return box;
  });
});

/** The largest distance between the sides of two rectangles. */
const boxDistance = (a, b) =>
  Math.max(...['left', 'right', 'top', 'bottom'].map((side) => Math.abs(a[side] - b[side])));

const eye = (page) => page.evaluate(() => sunder.stage.camera.position.toArray());
const distance = (a, b) => Math.hypot(...a.map((x, k) => x - b[k]));

/** The share of pixels of the stage that an action changes. */
async function changedBy(page, act) {
  const read = () => page.evaluate(() => {
    sunder.stage.draw();
    const gl = sunder.stage.renderer.getContext();
    const pixels = new Uint8Array(gl.drawingBufferWidth * gl.drawingBufferHeight * 4);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE,
      pixels);
    const previous = globalThis.previousPixels;
    globalThis.previousPixels = pixels;
    if (!previous) return 0;
    let count = 0;
    for (let i = 0; i < pixels.length; i += 4)
      if ([0, 1, 2].some((k) => pixels[i + k] !== previous[i + k])) ++count;
    return count / (pixels.length / 4);
  });
  await read();
  await act();
  await settle(page);
  return read();
}

const page = await open();
if (picture) {
  await page.evaluate(() => document.querySelector('details').open = true);
  await settle(page);
  await page.screenshot({ path: picture });
  await page.evaluate(() => document.querySelector('details').open = false);
}
facts.bytes = await page.evaluate(() => document.documentElement.outerHTML.length);
facts.views = await drawn(page);
const boxes = await expected(page);
facts.outline_distance = facts.views.map((view, i) => boxDistance(view, boxes[i]));
facts.listed_findings = await page.$$eval('#findings details', (list) => list.length);

// The worst vertex: a click moves the camera so that it stands in the middle of its viewport.
const before = await eye(page);
await page.click('#worst button');
await settle(page);
facts.camera_moved = distance(before, await eye(page));
facts.worst = await page.evaluate(() => {
  const { data, stage, models } = sunder;
  const values = data.arrays[0].values;
  const vertex = values.indexOf(Math.max(...values.filter((value) => !Number.isNaN(value))));
  const mesh = data.target.meshes.findLastIndex((mesh) => mesh.first_vertex <= vertex);
  const { position } = models.poseOf(
    { mesh, vertex: vertex - data.target.meshes[mesh].first_vertex });
  const [x, y] = stage.placeOf(position, 1);
  const { clientWidth: width, clientHeight: height } = stage.canvas;
  return { vertex, value: values[vertex], from_middle: Math.hypot(x - 0.75 * width, y - height / 2) };
});
const canvas = await (await page.$('#canvas')).boundingBox();
await page.mouse.move(canvas.x + 0.75 * canvas.width, canvas.y + canvas.height / 2);
await page.waitForSelector('#readout:not([hidden])');
facts.readout = await page.$eval('#readout', (output) => output.innerText);

facts.changed_by_heat_map = await changedBy(page, () => page.keyboard.press('h'));
await page.keyboard.press('h');
facts.changed_by_log = await changedBy(page, () => page.keyboard.press('l'));
facts.changed_by_bone = await changedBy(page, () => page.select('#shown', 'bone 1'));
facts.changed_by_layout = await changedBy(page, () => page.keyboard.press('v'));
facts.viewports_overlaid = await page.evaluate(() => sunder.stage.views.length);
facts.pose_given = await page.evaluate(() => sunder.player.pose);
// The chart: a click seeks the clip to that time and leaves the given pose.
facts.chart = await page.evaluate(() => ({
  lines: document.querySelectorAll('#chart path.line').length,
  thresholds: document.querySelectorAll('#chart .threshold').length,
  title: document.querySelector('#chart-title').textContent,
}));
const chart = await (await page.$('#chart')).boundingBox();
await page.mouse.click(chart.x + 0.25 * chart.width, chart.y + chart.height / 2);
await settle(page);
facts.sought = await page.evaluate(() => {
  const { player } = sunder;
  const cursor = document.querySelector('#chart .cursor');
  return { share: player.time / player.duration, pose: player.pose, is_playing: player.isPlaying,
    cursor: Number(cursor.getAttribute('x1')) / 1000, clock: document.querySelector('#clock').value };
});
await page.evaluate(() => sunder.player.seek(0));
await page.focus('#canvas');
await page.keyboard.press('Space');
await page.waitForFunction(() => sunder.player.time > 0.1);
await page.keyboard.press('Space');
facts.is_playing = await page.evaluate(() => sunder.player.isPlaying);
await page.click('#findings summary');
await settle(page);
facts.markers = await page.$$eval('.marker', (list) => list.length);

const dark = await open('dark');
facts.dark = (await dark.evaluate(() => sunder.stage.background.r)) < 0.2;
if (picture) await dark.screenshot({ path: picture.replace('.png', '_dark.png') });
await browser.close();
console.log(JSON.stringify(facts));
