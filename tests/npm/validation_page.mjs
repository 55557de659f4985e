// Opens a page of `sunder validate --html` in headless Chromium, uses it, and prints what happened
// as JSON. Usage: node validation_page.mjs <page.html> [<picture.png>]
import { boxDistance, changedBy, drawn, launch, openPage, runsOtherScripts, settle, unseen } from './browser.mjs';

const [file, picture] = process.argv.slice(2);
const browser = await launch();
const facts = { errors: [], requests: [] };
const open = (colourScheme) => openPage(browser, file, facts, { colourScheme });

/** Per viewport: the rectangle of the positions that are posed on the CPU. */
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

const eye = (page) => page.evaluate(() => sunder.stage.camera.position.toArray());
const distance = (a, b) => Math.hypot(...a.map((x, k) => x - b[k]));

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
facts.unseen = await unseen(page);
facts.runs_other_scripts = await runsOtherScripts(page, facts);

const dark = await open('dark');
facts.dark = (await dark.evaluate(() => sunder.stage.background.r)) < 0.2;
if (picture) await dark.screenshot({ path: picture.replace('.png', '_dark.png') });
await browser.close();
console.log(JSON.stringify(facts));
