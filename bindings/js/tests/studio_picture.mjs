// Draws the studio in which a character that waves is torn, and one wound's tension is painted:
// node tests/studio_picture.mjs <studio.html> <cactoro.glb> <picture.png> <painted.png>
import { basename } from 'node:path';
import { pathToFileURL } from 'node:url';
import { openPage } from './chromium.mjs';

const [studioFile, model, picture, painted] = process.argv.slice(2);
/** Low enough that the times of this machine are not in the picture. */
const SIZE = { width: 1280, height: 566, deviceScaleFactor: 1.5 };
const SETTINGS = { width: 0.006, depth: 0.2, tension: 0.14 };
const CLIP = { name: 'Wave', from: 0.05 };
/** Of the blade: right of the canvas' middle and below its top, as shares of its height. */
const STROKES = [
  [[-0.132, 0.555], [-0.035, 0.60], [0.096, 0.70]],
  [[-0.088, 0.385], [-0.035, 0.43], [0.07, 0.45]],
];
/** Of the brush, in the picture. */
const PAINTED = [[-0.06, 0.61], [-0.02, 0.63], [0.03, 0.67], [0.06, 0.71]];
/** Turns about the vertical, radians; distances and heights as shares of the first distance and of the size. */
const VIEW_OF_STROKES = { turn: -0.32, distance: 0.75 }, VIEW_OF_PICTURE = { turn: 0.25, distance: 1.04, rise: 0.12 };

/** In the page. Makes the frames itself, so that the picture does not depend on the machine's speed. */
async function tear({ settings, clip, strokes, views }) {
  const { studio, stage, tools, frame } = globalThis.studio, { camera, controls } = stage;
  let now = 0;
  const frames = (count) => { for (let i = 0; i < count; ++i) frame(now += 1000 / 60); };
  const set = (id, value, event) => {
    const input = document.getElementById(id);
    input.value = value;
    input.dispatchEvent(new Event(event));
  };
  const look = ({ turn, distance, rise = 0 }) => {
    const offset = camera.position.clone().sub(controls.target).multiplyScalar(distance).applyAxisAngle(camera.up, turn);
    offset.y += rise * studio.actor.size;
    camera.position.copy(controls.target).add(offset);
    controls.update();
    frames(1);
  };
  const at = ([x, y]) => {
    const box = document.getElementById('canvas').getBoundingClientRect();
    return { clientX: box.left + box.width / 2 + x * box.height, clientY: box.top + y * box.height, timeStamp: now };
  };
  for (const [id, value] of Object.entries(settings)) set(id, value, 'input');
  set('clip', [...document.getElementById('clip').options].find(({ text }) => text.endsWith(clip.name)).value, 'change');
  studio.actor.time = clip.from;
  frames(1);
  look(views[0]);
  for (const [first, ...rest] of strokes) {
    let from = first;
    if (!studio.begin(tools[1], at(first))) throw new Error('a stroke begins beside the character');
    for (const to of rest) {
      for (let i = 1; i <= 6; ++i) {
        frames(1);
        studio.move(at(from.map((value, k) => value + i / 6 * (to[k] - value))));
      }
      from = to;
    }
    frames(1);
    studio.end();
    frames(14);
  }
  look(views[1]);
}

/** In the page, after tear(): paints more tension along a stroke. */
async function paint({ stroke, time, factor }) {
  const { studio, frame } = globalThis.studio;
  let now = time;
  const frames = (count) => { for (let i = 0; i < count; ++i) frame(now += 1000 / 60); };
  const at = ([x, y]) => {
    const box = document.getElementById('canvas').getBoundingClientRect();
    return { clientX: box.left + box.width / 2 + x * box.height, clientY: box.top + y * box.height, timeStamp: now };
  };
  const set = (id, value, event) => {
    const input = document.getElementById(id);
    input.value = value;
    input.dispatchEvent(new Event(event));
  };
  document.querySelector('#tools label:last-of-type input').click();
  set('field', 'tension', 'change');
  set('factor', Math.log10(factor), 'input');
  set('radius', 0.07, 'input');
  studio.isPlaying = false;
  studio.applySettings();
  if (!studio.begin(studio.tool, at(stroke[0]))) throw new Error('paint begins beside the character');
  for (const place of stroke.slice(1)) {
    frames(1);
    studio.move(at(place));
  }
  studio.end();
  await studio.painted;
  frames(60);
}

const url = pathToFileURL(studioFile).href, { page, faults, close } = await openPage({ isOwn: (asked) => asked === url });
try {
  await page.setViewport(SIZE);
  await page.goto(url);
  await page.waitForSelector('body[data-operations]');
  await page.evaluate(() => globalThis.studio.stage.renderer.setAnimationLoop(null));
  await (await page.$('#file')).uploadFile(model);
  await page.waitForFunction((name) => globalThis.studio.studio.name === name, {}, basename(model, '.glb'));
  await page.evaluate(tear, { settings: SETTINGS, clip: CLIP, strokes: STROKES, views: [VIEW_OF_STROKES, VIEW_OF_PICTURE] });
  await page.screenshot({ path: picture });
  await page.evaluate(paint, { stroke: PAINTED, time: 1e6, factor: 3 });
  await page.screenshot({ path: painted });
  if (faults.length) throw new Error(faults.join('\n'));
} finally {
  await close();
}
