// Regions that are painted in the studio: seen, kept in files, felt by the tissue, undone.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { Sunder } from 'sunder-tear';
import { needsChromium } from './chromium.mjs';
import { cactus, folder, openFile, takeFrames, withStudio } from './studio_page.mjs';
import { commandFile } from './support.mjs';

/** The factors of a field, mesh after mesh, as the model of a GLB has them; null: it has none. */
async function factorsIn(glb, name) {
  const model = await Sunder.load(glb, { soft: false });
  const found = Array.from({ length: model.meshCount }, (_, mesh) => model.mesh(mesh).attributes.find((one) => one.name === name)?.values.slice());
  model.dispose();
  return found.every((values) => values === undefined) ? null : found;
}
const glbOf = async (page) => Buffer.from(await page.evaluate(() => {
  const { actor } = globalThis.studio.studio;
  return btoa(Array.from(actor.instance.toGLB(), (byte) => String.fromCharCode(byte)).join(''));
}), 'base64');
const operationsSay = (page, text) => page.waitForFunction((source) => new RegExp(source).test(document.getElementById('said').textContent), {}, text);

/** In the page: tools that tests use without a pointer. */
async function takeTools(page) {
  await takeFrames(page);
  await page.evaluate(() => {
    const { studio, tools, settings } = globalThis.studio;
    globalThis.drag = async (name, way, changed = {}) => {
      Object.assign(settings, changed);
      const events = way.map(([x, y]) => eventAt(x, y, studio.now = (studio.now ?? 0) + 0.1));
      studio.tool = tools.find((tool) => tool.name === name);
      if (!studio.begin(studio.tool, events[0])) throw new Error(`${name} took nothing`);
      for (const event of events.slice(1)) {
        frames(1, 0);
        studio.move(event);
      }
      frames(1, 0);
      studio.end();
      await studio.painted;
      frames(2, 0);
    };
    globalThis.step = async (which) => {
      studio[which]();
      await studio.painted;
      frames(2, 0);
    };
    /** Per field, how many vertices differ from 1. */
    globalThis.painted = () => Object.fromEntries(studio.actor.fields.map(({ field, values }) => [field, values.filter((value) => value !== 1).length]));
    studio.isPlaying = false;
    studio.applySettings();
    frames(2);
  });
}

test('a drag paints, colours show it, and the saved GLB has it as an attribute', needsChromium, async (t) => withStudio(async (page) => {
  const stop = () => page.evaluate(() => {
    globalThis.studio.studio.speed = 0;
    globalThis.studio.studio.actor.time = 0;
  });
  const drag = async () => {
    await page.mouse.move(430, 250);
    await page.mouse.down();
    for (let i = 1; i <= 8; ++i) {
      await page.mouse.move(430, 250 + 10 * i);
      await page.evaluate(() => new Promise(requestAnimationFrame));
    }
    await page.mouse.up();
  };
  await stop();
  await page.focus('#canvas');
  await page.keyboard.press('9');
  assert.equal(await page.$eval('#brush', ({ hidden }) => hidden), false);
  await page.select('#field', 'tension');
  await page.waitForFunction(() => !document.getElementById('legend').hidden);
  await drag();
  await operationsSay(page, '^Tension × 0\\.2 on [1-9][0-9]* vertices$');
  await page.evaluate(() => globalThis.studio.studio.painted);
  const glb = await glbOf(page), [...found] = (await factorsIn(glb, '_TENSION')).filter(Boolean).map((values) => Array.from(values)).flat();
  const low = found.filter((value) => value < 1);
  t.diagnostic(`${low.length} of ${found.length} vertices, from ${Math.min(...found).toFixed(3)}`);
  assert.ok(low.length > 10 && low.length < 0.3 * found.length);
  assert.ok(Math.abs(Math.min(...found) - 0.2) < 1e-3 && low.some((value) => value > 0.4), 'with a soft edge');
  assert.ok(await page.evaluate(() => {
    const { studio } = globalThis.studio;
    return studio.actor.object.children.flatMap(({ children }) => children).some(({ geometry }) => {
      const { array } = geometry.attributes.color ?? { array: [] };
      return array.some((red, i) => i % 3 === 0 && array[i + 2] > 1.5 * red);
    });
  }), 'blue where it is less');

  // The command reads it, and the page shows a file that was painted before.
  if (existsSync(commandFile)) {
    writeFileSync(join(folder, 'painted.glb'), glb);
    const blade = (x, y) => ({ base: [x, y, 2], tip: [x, y, 0] }), tear = { op: 'tear', pose: 'rest', stroke: [blade(-0.2, 1), blade(0.2, 1.2)] };
    writeFileSync(join(folder, 'tear.json'), JSON.stringify({ sunder_operations: 1, operations: [tear] }));
    execFileSync(commandFile, ['tear', join(folder, 'painted.glb'), '--ops', join(folder, 'tear.json'), '-o', join(folder, 'open.glb'), '--open', '-q',
      '--tissue-field', 'tension=attribute:_TENSION']);
  }
  await openFile(page, glb, 'again.glb');
  await page.waitForFunction(() => globalThis.studio.studio.name === 'again');
  assert.deepEqual(await page.evaluate(() => globalThis.studio.studio.actor.fields.map(({ field }) => field)), ['tension']);

  // Keys erase, and undo what was painted.
  await page.focus('#canvas');
  await page.keyboard.press('e');
  assert.equal(await page.$eval('#erases', ({ checked }) => checked), true);
  await stop();
  await drag();
  await operationsSay(page, '^Tension × 1 on');
  await page.evaluate(() => globalThis.studio.studio.painted);
  const left = (await factorsIn(await glbOf(page), '_TENSION')).filter(Boolean).map((values) => Array.from(values)).flat().filter((value) => value < 0.99);
  assert.ok(left.length < 0.5 * low.length, `${left.length} of ${low.length} vertices are left`);
  await page.keyboard.press('z');
  await page.evaluate(() => globalThis.studio.studio.painted);
  assert.deepEqual(Array.from((await factorsIn(await glbOf(page), '_TENSION')).filter(Boolean)[0]), found);
}));

test('a wound gapes by the tension that is painted beside it, and the wound stays the same', needsChromium, async (t) => withStudio(async (page) => {
  await takeTools(page);
  const seen = await page.evaluate(async () => {
    const { studio, settings } = globalThis.studio;
    settings.tension = 0.15;
    studio.applySettings();
    const wound = [[0.505, 0.3], [0.51, 0.35], [0.515, 0.4], [0.52, 0.45], [0.525, 0.5]];
    await drag('Blade', wound);
    /** How far tissue is from where the bones have it, once it rests. */
    const gape = () => {
      const { instance, model } = studio.actor, places = () => Array.from({ length: model.meshCount }, (_, mesh) => instance.mesh(mesh).positions.slice());
      frames(200);
      const open = places();
      instance.setTension(0);
      frames(200);
      let most = 0;
      for (const [mesh, shut] of places().entries())
        for (let v = 0; v < shut.length; v += 3) most = Math.max(most, Math.hypot(...[0, 1, 2].map((k) => open[mesh][v + k] - shut[v + k])));
      studio.applySettings();
      return most;
    };
    const digest = () => String(studio.actor.instance.digest), log = studio.actor.instance.log;
    frames(2);
    const before = { gape: gape(), digest: digest() };
    await drag('Paint', wound, { field: 'tension', factor: 3, radius: 0.08 });
    const after = { gape: gape(), digest: digest(), log: studio.actor.instance.log === log };
    await step('undo');
    return { before, after, undone: { gape: gape(), digest: digest(), fields: studio.actor.fields.length } };
  });
  t.diagnostic(`gapes ${seen.before.gape.toFixed(4)} m, painted ${seen.after.gape.toFixed(4)}, undone ${seen.undone.gape.toFixed(4)}`);
  assert.ok(seen.after.gape > 2 * seen.before.gape && seen.after.gape < 4 * seen.before.gape);
  assert.ok(Math.abs(seen.undone.gape / seen.before.gape - 1) < 0.06);
  assert.ok(seen.after.log, 'the same operations');
  assert.equal(seen.undone.digest, seen.before.digest);
  assert.equal(seen.undone.fields, 0);
}));

test('undo and redo go through operations and strokes in the order in which they were made', needsChromium, async () => withStudio(async (page) => {
  await takeTools(page);
  const seen = await page.evaluate(async () => {
    const { studio } = globalThis.studio, state = () => [studio.actor.instance.undoCounts.undo, painted()], states = [];
    await drag('Blade', [[0.505, 0.3], [0.515, 0.35]]);
    await drag('Paint', [[0.51, 0.4]], { field: 'strength', factor: 0.2, radius: 0.05 });
    await drag('Paint', [[0.51, 0.5]], { field: 'stiffness', factor: 4 });
    await drag('Blade', [[0.515, 0.45], [0.525, 0.5]]);
    states.push(state());
    for (const which of ['undo', 'undo', 'undo', 'undo', 'redo', 'redo', 'redo', 'redo']) {
      await step(which);
      states.push(state());
    }
    return { states, canUndo: studio.canUndo, canRedo: studio.canRedo };
  });
  const [both] = seen.states, { strength, stiffness } = both[1], one = { strength };
  assert.ok(strength > 0 && stiffness > 0);
  assert.deepEqual(seen.states, [[2, both[1]], [1, both[1]], [1, one], [1, {}], [0, {}], [1, {}], [1, one], [1, both[1]], [2, both[1]]]);
  assert.deepEqual([seen.canUndo, seen.canRedo], [true, false]);
}));

test('a finger paints', needsChromium, async () => withStudio(async (page) => {
  await page.evaluate(() => { globalThis.studio.studio.speed = 0.1; });
  const place = await page.evaluate(() => {
    const { stage, studio } = globalThis.studio, box = document.getElementById('canvas').getBoundingClientRect();
    const along = Array.from({ length: 60 }, (_, i) => ({ clientX: box.left + i / 60 * box.width, clientY: box.top + 0.5 * box.height }));
    const on = along.filter((point) => studio.actor.hit(stage.ray(point)));
    return on[Math.floor(on.length / 2)];
  });
  await page.tap('#tools label:last-of-type');
  const finger = await page.touchscreen.touchStart(place.clientX, place.clientY - 20);
  for (let i = 0; i < 4; ++i) {
    await finger.move(place.clientX, place.clientY - 20 + 5 * i);
    await page.evaluate(() => new Promise(requestAnimationFrame));
  }
  await finger.end();
  await operationsSay(page, '^Strength × 0\\.2 on [1-9]');
  await page.evaluate(() => globalThis.studio.studio.painted);
  assert.ok(await page.evaluate(() => globalThis.studio.studio.actor.fields.length === 1));
  await page.tap('#undo');
  await page.evaluate(() => globalThis.studio.studio.painted);
  assert.equal(await page.evaluate(() => globalThis.studio.studio.actor.fields.length), 0);
  await page.waitForSelector('#undo:disabled');
}, { size: { width: 390, height: 844, hasTouch: true, isMobile: true } }));

test('what a file calls a field but is none is left out', needsChromium, async () => withStudio(async (page) => {
  const model = await Sunder.load(cactus(), { soft: false }), count = model.mesh(0).vertexCount;
  const wrong = model.withAttributes([{ name: '_TENSION', values: new Float32Array(count).fill(-1) }, { name: '_STIFFNESS', values: new Float32Array(count).fill(2) }], { soft: false });
  await openFile(page, wrong.toGLB(), 'wrong.glb');
  await page.waitForFunction(() => globalThis.studio.studio.name === 'wrong');
  assert.deepEqual(await page.evaluate(() => globalThis.studio.studio.actor.fields.map(({ field }) => field)), ['stiffness']);
}));
