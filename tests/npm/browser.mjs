// Opens pages of the command in headless Chromium, without network, and reads their picture.
import { execSync } from 'node:child_process';
import { pathToFileURL } from 'node:url';
import puppeteer from 'puppeteer-core';

const PATIENCE = 240000;  // ms; a busy machine is no failure

export const launch = () => puppeteer.launch({
  timeout: PATIENCE,
  protocolTimeout: PATIENCE,
  executablePath: execSync('command -v chromium').toString().trim(),
  // Pictures by software: there is no graphics card where tests run.
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

/**
 * Opens a page. @param facts  errors and requests are added to its lists
 * @param ready  selector of what is there when it is
 */
export async function openPage(browser, file, facts, { colourScheme = 'light', width = 1440,
  height = 900, ready = '[data-ready=true]' } = {}) {
  const page = await browser.newPage();
  page.setDefaultTimeout(PATIENCE);
  await page.setViewport({ width, height });
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
  await page.waitForSelector(ready);
  await settle(page);
  return page;
}

/** Whether the page runs scripts that were not in it, such as a name could bring. */
export async function runsOtherScripts(page, facts) {
  const errors = facts.errors.length;
  const runs = await page.evaluate(async () => {
    const script = document.createElement('script');
    script.textContent = 'globalThis.pwned = 1';
    const holder = document.createElement('div');
    holder.innerHTML = '<img src="data:," onerror="globalThis.pwned = 2">';
    document.body.append(script, holder);
    await new Promise((resolve) => setTimeout(resolve, 300));
    script.remove();
    holder.remove();
    return 'pwned' in globalThis;
  });
  facts.errors.length = errors;  // of the policy that refused them
  return runs;
}

/** Control characters, and those that turn the direction of writing, in the texts of a page; but for line breaks. */
export const unseen = (page) => page.evaluate(() => {
  const texts = [document.title];
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_ELEMENT | NodeFilter.SHOW_TEXT);
  for (let node = walk.currentNode; node; node = walk.nextNode())
    if (node.nodeType !== Node.TEXT_NODE) texts.push(node.title ?? '', node.getAttribute('aria-label') ?? '');
    else if (!node.parentElement.closest('script, style')) texts.push(node.data);
  return texts.join('').match(/[\u0000-\u0009\u000b-\u001f\u007f-\u009f\u200e\u200f\u2028-\u202e\u2066-\u2069]/g)?.length ?? 0;
});

/** Waits for the picture that was asked for last. */
export const settle = (page) => page.evaluate(() => new Promise((resolve) => {
  requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(resolve)));
}));

/** Per viewport: the rectangle of pixels that are not background, in CSS pixels, and their share. */
export const drawn = (page) => page.evaluate(() => {
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

/** The largest distance between the sides of two rectangles. */
export const boxDistance = (a, b) =>
  Math.max(...['left', 'right', 'top', 'bottom'].map((side) => Math.abs(a[side] - b[side])));

/** The share of pixels of the stage that an action changes. */
export async function changedBy(page, act) {
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
