// Joins the page: controls, keys, pointers, frames.
import { Sunder } from 'sunder-tear';
import { byId, html, setText } from '../../../../tools/page_parts/src/elements.js';
import { listenToKeys } from '../../../../tools/page_parts/src/keys.js';
import { saveFile } from '../../../../tools/page_parts/src/save_file.js';
import { kindOf, receiveFiles } from './files.js';
import { Headset } from './headset.js';
import { HistoryList } from './history_list.js';
import { FIELDS } from './paint.js';
import { PaintedColours } from './painted_colours.js';
import { Readout } from './readout.js';
import { Stage } from './stage.js';
import { Studio } from './studio.js';
import { tools } from './tools.js';
import { WeightsError } from './weights_error.js';

const characters = JSON.parse(byId('characters').textContent);
const bytesOf = (base64) => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));

const settings = { width: 0, depth: 0, radius: 0, tension: 0, tissue: 'skin', givesWay: true, field: 'strength', factor: 0.2, erases: false };
const stage = new Stage(byId('canvas'));
const studio = new Studio(stage, settings, { weightsError: new WeightsError(byId('legend')), paintedColours: new PaintedColours(byId('legend')) }, say);
const readout = new Readout(byId('readout'));
const headset = new Headset(stage, studio);
const history = new HistoryList(byId('history'), (count) => studio.goBackTo(count));
let tool = tools[1];

function say(text, isFailure) {
  const said = byId('said');
  setText(said, text);
  said.hidden = false;
  said.style.color = isFailure ? 'var(--error)' : '';
}
/** Runs what may be refused, and says why. */
async function attempt(action) {
  try {
    await action();
  } catch (error) {
    say(error.message, true);
  }
}

// ---- the character and its clip ----

async function open(bytes, name) {
  await studio.open(bytes, name);
  const { model } = studio.actor;
  byId('clip').replaceChildren(...model.clips.map((clip, i) => html('option', { value: i }, clip.name || `Clip ${i + 1}`)));
  byId('clip').disabled = byId('play').disabled = byId('seek').disabled = model.clips.length === 0;
  const [note] = model.notes.filter(({ kind }) => kind !== 'information');
  say(note ? `${name}: ${note.text}` : `${name}: ${model.meshCount} meshes, ${model.bones.length} bones, ${model.clips.length} clips`, false);
}
/** Opens a character that is not the page's own, and lists it beside those. */
async function openOther(bytes, name) {
  await open(bytes, name);
  let i = characters.findIndex((listed) => listed.name === name);
  if (i < 0) {
    i = characters.push({}) - 1;
    byId('character').append(html('option', { value: i }, name));
  }
  characters[i] = { name, bytes };
  byId('character').value = i;
}
async function receive({ name, bytes }) {
  await attempt(async () => {
    const kind = kindOf(bytes);
    if (kind === 'log') say(`${studio.replay(bytes)} operations of ${name} done`, false);
    else if (kind === 'state') {
      await studio.restoreState(bytes);
      say(`${name} restored`, false);
    } else await openOther(bytes, name.replace(/\.[^.]*$/, ''));
  });
}
for (const [i, { name }] of characters.entries()) byId('character').append(html('option', { value: i }, name));
const openChosen = () => attempt(() => {
  const { name, glb, bytes = bytesOf(glb) } = characters[byId('character').value];
  return open(bytes, name);
});
byId('character').addEventListener('change', openChosen);
receiveFiles({ button: byId('open'), input: byId('file'), target: byId('stage'), onFile: receive });

function togglePlay() {
  studio.isPlaying = !studio.isPlaying;
  studio.applySettings();
  byId('play').textContent = studio.isPlaying ? 'Pause' : 'Play';
}
byId('play').addEventListener('click', togglePlay);
byId('clip').addEventListener('change', () => {
  studio.actor.play(Number(byId('clip').value));
  studio.applySettings();
});
byId('seek').addEventListener('input', () => { studio.actor.time = byId('seek').value * studio.actor.duration; });
byId('speed').addEventListener('change', () => { studio.speed = Number(byId('speed').value); });

// ---- tools and settings ----

function choose(next) {
  tool = next;
  studio.tool = tool;
  byId('hint').textContent = tool.hint;
  byId('brush').hidden = !tool.paints;
  byId('stage').dataset.tool = tool.begin ? 'works' : 'turns';
  for (const input of byId('tools').querySelectorAll('input')) input.checked = tools[input.value] === tool;
}
for (const [i, { name }] of tools.entries())
  byId('tools').append(html('label', {}, html('input', { type: 'radio', name: 'tool', value: i, onchange: () => choose(tools[i]) }), name));
for (const name of ['width', 'depth', 'radius', 'tension']) {
  const input = byId(name), shown = document.querySelector(`output[for=${name}]`);
  const apply = () => {
    settings[name] = Number(input.value);
    shown.textContent = `${(100 * settings[name]).toFixed(1)} %`;
    if (name === 'tension' && studio.actor) studio.applySettings();
  };
  input.addEventListener('input', apply);
  apply();
}
for (const field of FIELDS) byId('field').append(html('option', { selected: field === settings.field }, field));
byId('field').addEventListener('change', () => { settings.field = byId('field').value; });
const applyFactor = () => {
  settings.factor = Number((10 ** Number(byId('factor').value)).toPrecision(2));
  document.querySelector('output[for=factor]').textContent = `× ${settings.factor}`;
};
byId('factor').addEventListener('input', applyFactor);
applyFactor();
byId('erases').addEventListener('change', ({ target }) => { settings.erases = target.checked; });
byId('weights-error').addEventListener('change', ({ target }) => { studio.weightsError.isShown = target.checked; });
byId('gives-way').addEventListener('change', ({ target }) => { settings.givesWay = target.checked; });

const canvas = byId('canvas');
let pointer = null;
canvas.addEventListener('pointerdown', (event) => {
  if (pointer === null) {
    if (event.button !== 0 || !studio.begin(tool, event)) return;
    pointer = event.pointerId;
    canvas.setPointerCapture(pointer);
  }
  event.stopImmediatePropagation();  // the camera stays, also when a second finger comes
}, { capture: true });
canvas.addEventListener('pointermove', (event) => { if (event.pointerId === pointer) studio.move(event); });
for (const type of ['pointerup', 'pointercancel'])
  canvas.addEventListener(type, (event) => {
    if (event.pointerId !== pointer) return;
    pointer = null;
    studio.end();
  });

// ---- history and files ----

byId('undo').addEventListener('click', () => studio.undo());
byId('redo').addEventListener('click', () => studio.redo());
const saveLog = () => attempt(() => saveFile(studio.actor.instance.log, `${studio.name}_ops.json`, 'application/json'));
const saveGLB = () => attempt(() => saveFile(studio.actor.instance.toGLB(), `${studio.name}_torn.glb`, 'model/gltf-binary'));
byId('save-log').addEventListener('click', saveLog);
byId('save-glb').addEventListener('click', saveGLB);
byId('save-snapshot').addEventListener('click', () => attempt(() => saveFile(studio.saveState(), `${studio.name}.snapshot`)));
const fit = () => stage.show(studio.actor.box);
byId('fit').addEventListener('click', fit);
byId('help').addEventListener('click', () => byId('helping').showModal());

// ---- the headset ----

byId('enter-vr').hidden = !await Headset.isThere();
byId('enter-vr').addEventListener('click', () => attempt(async () => {
  if (headset.session) return headset.session.end();
  await headset.enter(() => { byId('enter-vr').textContent = 'Enter VR'; });
  byId('enter-vr').textContent = 'Leave VR';
}));

// ---- frames ----

let last = performance.now(), digest = null;
function frame(now) {
  const figures = studio.frame((now - last) / 1000, now / 1000);
  last = now;
  if (figures) {
    readout.add({ ...figures, memory: Sunder.memoryBytes });
    readout.others = studio.weightsError.lines;
    const { instance } = studio.actor, { undo } = instance.undoCounts;
    byId('undo').disabled = !studio.canUndo;
    byId('redo').disabled = !studio.canRedo;
    history.update(instance);
    if (instance.digest !== digest) {
      digest = instance.digest;
      byId('digest').textContent = undo === 0 ? 'Nothing is torn yet.' : `Digest ${digest.toString(16).padStart(16, '0')}`;
    }
    if (studio.actor.duration > 0) byId('seek').value = (studio.actor.time % studio.actor.duration) / studio.actor.duration;
    document.body.dataset.operations = undo;
  }
  headset.show([...readout.lines, [byId('said').textContent, '']]);
  stage.draw();
}

for (const name of Sunder.materialNames) byId('tissue').append(html('option', { selected: name === settings.tissue }, name));
byId('tissue').addEventListener('change', () => attempt(() => {
  settings.tissue = byId('tissue').value;
  studio.actor.setTissue(settings.tissue);
  studio.applySettings();
}));
/** What the address names, `?model=fox.glb&name=Fox`, from where the page is from; @returns why not */
async function openNamed(query) {
  const model = query.get('model');
  if (model === null) return '';
  try {
    const answer = await fetch(model);
    if (!answer.ok) throw new Error(`${answer.status} ${answer.statusText}`);
    await openOther(new Uint8Array(await answer.arrayBuffer()), query.get('name') ?? model.replace(/.*\/|\.[^.]*$/g, ''));
    return '';
  } catch (error) {
    return `${model}: ${error.message}`;
  }
}
choose(tool);
const fault = await openNamed(new URLSearchParams(location.search));
if (!studio.actor) {
  byId('character').value = 0;
  await openChosen();
}
if (fault) say(fault, true);
listenToKeys(canvas, stage, {
  ' ': togglePlay, z: () => studio.undo(), y: () => studio.redo(), s: saveLog, g: saveGLB, f: fit, w: () => byId('weights-error').click(), e: () => byId('erases').click(),
  '?': () => byId('helping').showModal(), ...Object.fromEntries(tools.map((one, i) => [i + 1, () => choose(one)])),
});
stage.renderer.setAnimationLoop(frame);
/** For tests and for the console; frame(now) makes one. */
globalThis.studio = { studio, stage, readout, settings, tools, frame };
