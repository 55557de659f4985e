// Headless Chromium, and what a page must not do: log errors, or ask for anything from elsewhere.
import { execSync } from 'node:child_process';
import puppeteer from 'puppeteer-core';

export const PATIENCE = 240000;  // ms; a busy machine is no failure
const chromium = execSync('command -v chromium || true').toString().trim();
/** Of tests that need it. */
export const needsChromium = { skip: chromium === '' && 'chromium is absent', timeout: PATIENCE * 3 };
const FLAGS = ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync'];

/** @param isOwn  whether a request is for what belongs to the page @returns { page, faults, close } */
export async function openPage({ isOwn, prepare = async () => {} }) {
  const browser = await puppeteer.launch({ executablePath: chromium, args: FLAGS, timeout: PATIENCE, protocolTimeout: PATIENCE });
  const page = await browser.newPage(), faults = [];
  page.setDefaultTimeout(PATIENCE);
  page.on('console', (message) => {
    if (['error', 'warn'].includes(message.type()) && !/GPU stall|swiftshader/i.test(message.text())) faults.push(message.text());
  });
  page.on('pageerror', (error) => faults.push(String(error)));
  page.on('request', (request) => { if (!isOwn(request.url()) && !/^(data|blob):/.test(request.url())) faults.push(`asked for ${request.url()}`); });
  await prepare(page);
  return { page, faults, close: () => browser.close() };
}

/** How many pixels of the page look like flesh. */
export async function fleshPixels(page) {
  const shot = await page.screenshot({ encoding: 'base64' });
  return page.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let found = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i] > 60 && data[i] > 2.2 * data[i + 1] && data[i] > 2.2 * data[i + 2]) ++found;
    return found;
  }, shot);
}
