// Uses a page of `sunder view` in headless Chromium and prints what happened as JSON.
// Usage: node view_page.mjs place <page.html> <folder>   clips, tools, logs saved into the folder
//        node view_page.mjs probe <page.html>            every tool at places that the model covers
//        node view_page.mjs torn <page.html>             a page with a torn model and operations
//        node view_page.mjs given <page.html>            the poses of all operations that the page was given
//        node view_page.mjs picture <page.html> <p.png>  draws the demo's cactus with every tool
//        node view_page.mjs colours <page.html> <places>  the pixels at places of the model: x,y,z/x,y,z ...
//        node view_page.mjs broken <page.html>           a page whose data cannot be read
import { readdirSync, readFileSync, renameSync } from 'node:fs';
import { join } from 'node:path';
import { boxDistance, changedBy, drawn, launch, openPage, runsOtherScripts, settle, unseen } from './browser.mjs';

const [mode, file, folder] = process.argv.slice(2);
const browser = await launch();
const facts = { errors: [], requests: [] };
let downloads = null;  // the session that says how far saved files are

/** The rectangle of the shown model, posed on the CPU. */
const expected = (page) => page.evaluate(() => {
  const { stage, which, data } = sunder;
  const positions = sunder.positions(which);
  const box = { left: Infinity, right: -Infinity, top: Infinity, bottom: -Infinity };
  for (const index of data[which].indices) {
    const place = stage.placeOf(positions.subarray(index * 3, index * 3 + 3), 0);
    if (!place) continue;
    box.left = Math.min(box.left, place[0]);
    box.right = Math.max(box.right, place[0]);
    box.top = Math.min(box.top, place[1]);
    box.bottom = Math.max(box.bottom, place[1]);
  }
  return box;
});

const seek = async (page, time) => {
  await page.$eval('#seek', (slider, value) => {
    slider.value = value;
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  }, time);
  await settle(page);
};

const chooseClip = async (page, clip) => {
  await page.select('#clip', String(clip));
  await settle(page);
};

const count = (page) => page.$$eval('#operations li', (list) => list.length);

/** Clicks a share of the canvas; says the ray of that pixel, from the camera's own matrices. */
async function clickAt(page, x, y) {
  const area = await (await page.$('#canvas')).boundingBox();
  const place = [Math.round(x * area.width), Math.round(y * area.height)];
  await page.mouse.click(area.x + place[0], area.y + place[1]);
  await settle(page);
  return page.evaluate(([px, py], width, height) => {
    const { camera } = sunder.stage;
    const m = camera.matrixWorld.elements;
    const tall = Math.tan((camera.fov * Math.PI) / 360), wide = (tall * width) / height;
    const right = (2 * px / width - 1) * wide, up = (1 - 2 * py / height) * tall;
    return { eye: [m[12], m[13], m[14]],
      direction: [0, 1, 2].map((k) => right * m[k] + up * m[4 + k] - m[8 + k]) };
  }, place, area.width, area.height);
}

/** Saves the log by the button; the file gets a name when the browser says that all of it is written. */
async function save(page, name) {
  const written = new Promise((resolve, reject) => {
    const tooLong = setTimeout(() => reject(new Error(`${name} was not saved in a minute`)), 60000);
    const follow = ({ state }) => {
      if (state === 'inProgress') return;
      clearTimeout(tooLong);
      downloads.off('Browser.downloadProgress', follow);
      resolve();
    };
    downloads.on('Browser.downloadProgress', follow);
  });
  await page.click('#save');
  await written;
  renameSync(join(folder, readdirSync(folder).find((entry) => entry.endsWith('_ops.json'))), join(folder, name));
  const text = readFileSync(join(folder, name), 'utf8');
  return text === await page.evaluate(() => sunder.list.text);
}

const removeAll = async (page) => {
  while (await count(page)) await page.click('#operations li button[aria-label]');
};

/** Controls that say nothing to a screen reader. */
const nameless = (page) => page.evaluate(() =>
  [...document.querySelectorAll('button, input, select, canvas, output, dialog')].filter((node) =>
    !(node.textContent.trim() || node.getAttribute('aria-label') || node.title || node.labels?.length ||
      node.matches('output, dialog[aria-labelledby]'))).map((node) => node.outerHTML));

async function testClips(page) {
  facts.clips = [];
  const clips = await page.evaluate(() => sunder.data.clips.map(({ duration }) => duration));
  for (const [clip, duration] of clips.entries()) {
    await chooseClip(page, clip);
    await seek(page, 0.37 * duration);
    const [picture] = await drawn(page);
    facts.clips.push({ outline_distance: boxDistance(picture, await expected(page)),
      share: picture.share, time: await page.evaluate(() => sunder.player.time) });
  }
  for (const pose of ['Rest', 'Bind']) {
    await page.evaluate((name) => [...document.querySelectorAll('#poses button')]
      .find((button) => button.textContent === name).click(), pose);
    await settle(page);
    facts[pose.toLowerCase()] = boxDistance((await drawn(page))[0], await expected(page));
  }
  await page.focus('#canvas');
  await page.keyboard.press('Space');
  const start = await page.evaluate(() => sunder.player.time);
  await page.waitForFunction((from) => sunder.player.time !== from, {}, start);
  await page.keyboard.press('Space');
  facts.is_playing = await page.evaluate(() => sunder.player.isPlaying);
}

const pose = (page) => page.evaluate(() => sunder.player.time);

async function testTools(page) {
  await chooseClip(page, 0);
  await seek(page, 0.8);
  await page.keyboard.press('2');
  const tear = [await clickAt(page, 0.5, 0.42), await clickAt(page, 0.51, 0.5), await clickAt(page, 0.49, 0.6)];
  facts.pending = await page.evaluate(() => sunder.placing.clicks.length);
  await page.keyboard.press('Enter');
  facts.tear = { rays: tear, time: await pose(page), opened: await page.evaluate(() => sunder.opened),
    saved: await save(page, 'tear.json') };
  facts.changed_by_overlays = await changedBy(page, () => page.keyboard.press('o'));
  await page.keyboard.press('o');

  await removeAll(page);
  await seek(page, 1.3);
  await page.keyboard.press('3');
  const cut = [await clickAt(page, 0.475, 0.55), await clickAt(page, 0.525, 0.52)];
  facts.cut = { rays: cut, time: await pose(page), opened: await page.evaluate(() => sunder.opened), saved: await save(page, 'cut.json') };

  await removeAll(page);
  await page.select('#setting-by', 'points');
  await page.select('#setting-bounds', 'points');
  const three = [await clickAt(page, 0.48, 0.55), await clickAt(page, 0.52, 0.55), await clickAt(page, 0.5, 0.62)];
  facts.disc = { rays: three, time: await pose(page), saved: await save(page, 'disc.json') };

  await removeAll(page);
  await page.keyboard.press('4');
  await seek(page, 0.4);
  const bore = [await clickAt(page, 0.5, 0.5)];
  facts.drill = { rays: bore, time: await pose(page), saved: await save(page, 'drill.json') };
}

/** What is aimed at limbs, and incisions; with the segments that the page previews for each. */
async function testAimedTools(page) {
  const preview = () => page.evaluate(() => sunder.opened);
  await chooseClip(page, 0);
  await seek(page, 0.8);
  for (const what of ['slash', 'sever', 'puncture']) {
    await removeAll(page);
    await page.keyboard.press('5');
    await page.select('#setting-what', what);
    const rays = [await clickAt(page, 0.5, 0.4)];
    facts[what] = { rays, time: await pose(page), opened: await preview(), saved: await save(page, `${what}.json`) };
  }
  await removeAll(page);
  await page.keyboard.press('6');
  const rays = [await clickAt(page, 0.5, 0.45), await clickAt(page, 0.505, 0.55)];
  facts.pending_preview = (await preview()).length;
  await page.keyboard.press('Enter');
  facts.incision = { rays, time: await pose(page), opened: await preview(), saved: await save(page, 'incision.json') };
  await removeAll(page);
  facts.without_operations = (await preview()).length;
  await page.keyboard.press('4');
}

async function testPosesOfTools(page) {
  for (const [pose, button] of [['rest', 0], ['bind', 1]]) {
    await removeAll(page);
    await page.evaluate((i) => document.querySelectorAll('#poses button')[i].click(), button);
    await settle(page);
    const rays = [await clickAt(page, 0.5, 0.5)];
    facts[`drill_${pose}`] = { rays, saved: await save(page, `drill_${pose}.json`) };
  }
}

async function testUndo(page) {
  await removeAll(page);
  await page.keyboard.press('4');
  for (const y of [0.45, 0.5, 0.55]) await clickAt(page, 0.5, y);
  facts.undo = [await count(page)];
  for (const key of ['z', 'z', 'y']) {
    await page.keyboard.press(key);
    facts.undo.push(await count(page));
  }
  await page.click('#operations li:first-child button[aria-label]');
  facts.undo.push(await count(page));
  await page.keyboard.press('z');
  facts.undo.push(await count(page));
  // Points that are not an operation yet go first.
  await page.keyboard.press('2');
  await clickAt(page, 0.5, 0.5);
  await page.keyboard.press('z');
  facts.undo.push(await count(page), await page.evaluate(() => sunder.placing.clicks.length));
  // A click beside the model says so and places nothing; another pose drops points.
  await clickAt(page, 0.02, 0.02);
  facts.beside = await page.$eval('#said', (said) => said.textContent);
  await clickAt(page, 0.5, 0.5);
  await seek(page, 0.2);
  facts.dropped = await page.evaluate(() => sunder.placing.clicks.length);
  // Numbers are typed, not taken as keys of the page; Enter on a button is that button's.
  await page.click('#setting-depth', { count: 3 });
  await page.keyboard.type('0.125');
  await page.keyboard.press('Tab');
  facts.typed = await page.evaluate(() => [sunder.placing.tool, sunder.settings.current.depth]);
  await page.focus('#undo');
  await page.keyboard.press('Enter');
  facts.undo.push(await count(page));
  await page.click('#copy');
  await settle(page);
  facts.copied = await page.$eval('#said', (said) => said.textContent);
}

async function testBones(page) {
  await page.keyboard.press('1');
  await page.keyboard.press('b');
  const bone = 3;
  const area = await (await page.$('#canvas')).boundingBox();
  const [x, y] = await page.evaluate((i) =>
    sunder.stage.placeOf([...sunder.player.bones.subarray(i * 12 + 9, i * 12 + 12)], 0), bone);
  await page.mouse.move(area.x + x + 3, area.y + y + 2);
  await page.mouse.move(area.x + x, area.y + y);
  await settle(page);
  facts.bone = { shown: await page.$eval('#readout', (output) => output.textContent),
    name: await page.evaluate((i) => sunder.data.source.bones[i], bone) };
}

async function testPlacing() {
  downloads = await browser.target().createCDPSession();
  await downloads.send('Browser.setDownloadBehavior',
    { behavior: 'allow', downloadPath: folder, eventsEnabled: true });
  const page = await openPage(browser, file, facts);
  facts.title = await page.$eval('#title', (title) => title.textContent);
  facts.injected = await page.evaluate(() =>
    [globalThis.pwned ?? null, document.querySelectorAll('img').length]);
  facts.bytes = await page.evaluate(() => document.documentElement.outerHTML.length);
  await testClips(page);
  await testTools(page);
  await testAimedTools(page);
  await testPosesOfTools(page);
  await testUndo(page);
  await testBones(page);
  facts.shown_error = await page.evaluate(() => {
    globalThis.showError(sunder.data.source.title + sunder.data.source.bones.join(''));
    const error = document.getElementById('error');
    return { text: error.textContent, parts: error.children.length };
  });
  facts.unseen = await unseen(page);
  await page.$eval('#error', (error) => { error.hidden = true; });
  facts.runs_other_scripts = await runsOtherScripts(page, facts);
  facts.changed_by_colours = await changedBy(page, () => page.keyboard.press('c'));
  facts.nameless = await nameless(page);
  await page.keyboard.press('?');
  facts.help = await page.$eval('#keys', (dialog) => dialog.open);
  const narrow = await openPage(browser, file, facts, { width: 400, height: 800, colourScheme: 'dark' });
  facts.narrow = await narrow.evaluate(() => document.documentElement.scrollWidth);
  facts.narrow_share = (await drawn(narrow))[0].share;
}

/** Uses every tool in the middle of a clip, where the picture of any model says that there is one. */
async function testProbe() {
  const page = await openPage(browser, file, facts);
  const clip = await page.evaluate(() => Math.floor(sunder.data.clips.length / 2));
  if (await page.evaluate(() => sunder.data.clips.length > 1)) await chooseClip(page, clip);
  await seek(page, 0.37 * await page.evaluate(() => sunder.player.duration));
  await page.evaluate(() => sunder.fit());
  await settle(page);
  facts.clip = clip;
  facts.time = await pose(page);
  facts.has_clips = await page.evaluate(() => sunder.data.clips.length > 0);
  facts.outline_distance = boxDistance((await drawn(page))[0], await expected(page));
  const places = await page.evaluate(() => {
    const { clientWidth: width, clientHeight: height } = sunder.stage.canvas;
    const found = [];
    for (let y = 0.02; y < 1; y += 0.04)
      for (let x = 0.02; x < 1; x += 0.04) if (sunder.pick(x * width, y * height)) found.push([x, y]);
    return found;
  });
  const use = async (key, shares) => {
    await page.keyboard.press(key);
    const rays = [];
    for (const share of shares)
      rays.push(await clickAt(page, ...places[Math.floor(share * (places.length - 1))]));
    return rays;
  };
  facts.drill = await use('4', [0.3]);
  facts.cut = await use('3', [0.5, 0.8]);
  facts.tear = await use('2', [0.6, 0.61]);
  await page.keyboard.press('Enter');
  facts.log = JSON.parse(await page.evaluate(() => sunder.list.text));
}

/** The share of pixels whose colour is like a given one. */
const shareOf = (page, accept) => page.evaluate((source) => {
  const like = new Function('r', 'g', 'b', `return ${source}`);
  sunder.stage.draw();
  const gl = sunder.stage.renderer.getContext();
  const pixels = new Uint8Array(gl.drawingBufferWidth * gl.drawingBufferHeight * 4);
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let found = 0;
  for (let i = 0; i < pixels.length; i += 4) if (like(pixels[i], pixels[i + 1], pixels[i + 2])) ++found;
  return found / (pixels.length / 4);
}, accept);

async function testTorn() {
  const page = await openPage(browser, file, facts);
  facts.which = await page.evaluate(() => sunder.which);
  facts.listed = await page.$$eval('#operations .choose', (list) => list.map((one) => one.innerText));
  facts.text = await page.evaluate(() => sunder.list.text);
  facts.facts = await page.$eval('#torn-facts', (list) => list.innerText);
  await page.keyboard.press('o');  // hides the operations
  await settle(page);
  const red = 'r > 150 && g < 90 && b < 110', blue = 'b > 110 && r < 90 && b > g';
  facts.torn = { lips: await shareOf(page, red), piece: await shareOf(page, blue) };
  const [picture] = await drawn(page);
  facts.torn.outline_distance = boxDistance(picture, await expected(page));
  await page.keyboard.press('t');
  await settle(page);
  facts.source = { lips: await shareOf(page, red), piece: await shareOf(page, blue) };
  // A click on an operation goes to its pose.
  await page.click('#operations .choose');
  await settle(page);
  facts.pose = await page.evaluate(() => [sunder.player.clip, sunder.player.time, sunder.player.pose]);
}

async function testGiven() {
  const page = await openPage(browser, file, facts);
  facts.positions = [];
  for (let i = 0; i < await count(page); ++i) {
    await page.click(`#operations li:nth-child(${i + 1}) .choose`);
    await settle(page);
    facts.positions.push(await page.evaluate(() => [...sunder.positions('source')]));
  }
  facts.said = await page.$eval('#said', (said) => said.textContent);
}

async function testColours() {
  const page = await openPage(browser, file, facts);
  const places = folder.split('/').map((place) => place.split(',').map(Number));
  facts.colours = await page.evaluate((all) => {
    const { stage } = sunder;
    stage.draw();
    const gl = stage.renderer.getContext();
    const scale = gl.drawingBufferWidth / stage.canvas.clientWidth;
    return all.map((place) => {
      const [x, y] = stage.placeOf(place, 0);
      const pixel = new Uint8Array(4);
      gl.readPixels(x * scale, gl.drawingBufferHeight - y * scale, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      return [...pixel.subarray(0, 3)];
    });
  }, places);
}

async function testBroken() {
  const page = await openPage(browser, file, facts, { ready: '#error:not([hidden])' });
  facts.error = await page.$eval('#error', (error) => error.textContent);
}

async function drawPicture() {
  const page = await openPage(browser, file, facts, { width: 1200, height: 760 });
  await seek(page, 0.8);
  await page.keyboard.press('2');
  for (const [x, y] of [[0.46, 0.36], [0.44, 0.43], [0.46, 0.5]]) await clickAt(page, x, y);
  await page.keyboard.press('Enter');
  await page.keyboard.press('4');
  await clickAt(page, 0.5, 0.3);
  await page.keyboard.press('3');
  await page.select('#setting-bounds', 'points');
  await clickAt(page, 0.44, 0.66);
  await clickAt(page, 0.56, 0.62);
  await page.keyboard.press('b');
  await page.evaluate(() => sunder.stage.turn(-0.5, 0.25));
  await page.mouse.move(5, 5);
  await settle(page);
  await page.screenshot({ path: folder });
}

await { place: testPlacing, picture: drawPicture, probe: testProbe, torn: testTorn, given: testGiven, colours: testColours, broken: testBroken }[mode]();
await browser.close();
console.log(JSON.stringify(facts));
