// What a frame of the studio takes beside drawing, by the page's own read-out, in headless Chromium.
// Usage: node bench/studio_frames.mjs <index.html of npm run studio>
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { Sunder } from 'sunder-tear';
import { openPage } from '../tests/chromium.mjs';

const RINGS = 159, AROUND = 125, BONES = 12, RADIUS = 0.25, HEIGHT = 2;

/** A closed limb of 20,002 vertices on a chain of bones, each vertex on up to four of them. */
function limb() {
  const positions = [], triangles = [], slots = [], weights = [];
  const add = (x, y, z) => {
    const place = y / HEIGHT * (BONES - 1), near = [...Array(BONES).keys()].map((bone) => ({ bone, weight: Math.max(0, 1 - Math.abs(place - bone) / 2) }));
    const used = near.sort((a, b) => b.weight - a.weight).slice(0, 4), sum = used.reduce((total, { weight }) => total + weight, 0);
    positions.push(x, y, z);
    slots.push(...used.map(({ bone }) => bone));
    weights.push(...used.map(({ weight }) => weight / sum));
  };
  add(0, 0, 0);
  for (let ring = 0; ring <= RINGS; ++ring) {
    const y = HEIGHT * ring / RINGS, radius = RADIUS * (1 + 0.15 * Math.sin(4 * y));
    for (let i = 0; i < AROUND; ++i) add(radius * Math.cos(2 * Math.PI * i / AROUND), y, radius * Math.sin(2 * Math.PI * i / AROUND));
  }
  add(0, HEIGHT, 0);
  const last = positions.length / 3 - 1, at = (ring, i) => 1 + ring * AROUND + i % AROUND;
  for (let i = 0; i < AROUND; ++i) {
    triangles.push(0, at(0, i), at(0, i + 1), last, at(RINGS, i + 1), at(RINGS, i));
    for (let ring = 0; ring < RINGS; ++ring) {
      triangles.push(at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i), at(ring + 1, i + 1), at(ring, i + 1));
    }
  }
  const step = HEIGHT / (BONES - 1);
  const bones = Array.from({ length: BONES }, (_, i) => ({ name: `bone ${i}`, parent: i ? i - 1 : undefined, translation: [0, i ? step : 0, 0] }));
  const boneFromBind = bones.flatMap((_, i) => [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -i * step, 0]);
  return { name: 'limb', bones, skins: [{ bones: [...Array(BONES).keys()], boneFromBind }], meshes: [{ positions, triangles, slots, weights }] };
}

/** In the page: the figures of frames in which the limb bends. */
function measure(isTorn) {
  const { studio, stage, settings, tools } = globalThis.studio, { actor } = studio, { instance } = actor;
  stage.renderer.setAnimationLoop(null);
  Object.assign(settings, { tension: 0.15, width: 0.004, depth: 0.04 });
  studio.applySettings();
  let now = 0, hold = null, from = null;
  const { bones } = actor.model;
  const bend = () => {
    const half = 0.01 * Math.sin(3 * now), rotation = [0, 0, Math.sin(half), Math.cos(half)];
    instance.setTransforms(bones.map(({ rest }) => ({ ...rest, rotation })));
  };
  const frame = () => {
    now += 1 / 72;
    bend();
    hold?.move([from[0], from[1], from[2] + 0.03 * Math.sin(20 * now)]);
    return studio.frame(1 / 72);
  };
  if (isTorn) {
    const box = document.getElementById('canvas').getBoundingClientRect();
    const pointer = (y) => ({ clientX: box.left + 0.5 * box.width, clientY: box.top + y * box.height, timeStamp: 1000 * now });
    frame();
    studio.begin(tools[1], pointer(0.4));
    for (let i = 1; i <= 20; ++i) {
      frame();
      studio.move(pointer(0.4 + 0.01 * i));
    }
    studio.end();
    frame();
    const contact = actor.hit(stage.ray(pointer(0.35)));
    from = [...contact.place];
    hold = instance.hold(contact, from);
  }
  for (let i = 0; i < 60; ++i) frame();
  const FRAMES = 400, taken = [];
  let awake = 0;
  for (let i = 0; i < FRAMES; ++i) {
    taken.push(frame());
    awake += instance.tissue.isAwake;
  }
  // The clock of a page has steps of 0.1 ms, and other programs make some frames longer: the mean of the middle half.
  const usual = (name) => {
    const middle = taken.map((figures) => figures[name]).sort((a, b) => a - b).slice(FRAMES / 4, 3 * FRAMES / 4);
    return middle.reduce((sum, value) => sum + value, 0) / middle.length;
  };
  return { ...Object.fromEntries(Object.keys(taken[0]).map((name) => [name, usual(name)])), awake: awake / FRAMES, particles: instance.tissue.particleCount, inModel: instance.mesh(0).vertexCount, bones: bones.length };
}

const file = pathToFileURL(resolve(process.argv[2])).href;
const model = await Sunder.fromArrays(limb()), glb = Buffer.from(model.toGLB()).toString('base64');
const { page, faults, close } = await openPage({ isOwn: (url) => url === file });
await page.setViewport({ width: 1280, height: 720 });
await page.goto(file);
await page.waitForSelector('body[data-operations]');
console.log('milliseconds per frame                     all  tissue  posing  copies      kB  posed');
for (const [name, isTorn] of [['untorn, bending', false], ['torn, tissue awake, bending', true]]) {
  await page.evaluate((base64) => globalThis.studio.studio.open(Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)), 'limb'), glb);
  const it = await page.evaluate(measure, isTorn);
  const shown = [it.own, it.tissue / 1000, it.drawing / 1000, it.upload].map((value) => value.toFixed(2).padStart(7)).join(' ');
  console.log(`${name.padEnd(38)} ${shown}  ${(it.bytes / 1024).toFixed(0).padStart(6)} ${it.vertices.toFixed(0).padStart(6)}`);
  console.log(`  ${it.inModel} vertices, ${it.bones} bones, ${it.particles} particles, awake in ${(100 * it.awake).toFixed(0)} % of the frames`);
}
for (const fault of faults) console.error(fault);
await close();
