// Joins the page: controls, keys, pointers, frames.
import { Sunder } from 'sunder-tear';
import { kindOf, receiveFiles, save } from './files.js';
import { Headset } from './headset.js';
import { HistoryList } from './history_list.js';
import { Readout } from './readout.js';
import { Stage } from './stage.js';
import { Studio } from './studio.js';
import { tools } from './tools.js';
import { WeightsError } from './weights_error.js';

const element = (id) => document.getElementById(id);
const characters = JSON.parse(element('characters').textContent);
const bytesOf = (base64) => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));

const settings = { width: 0, depth: 0, radius: 0, tension: 0, tissue: 'skin', givesWay: true };
const stage = new Stage(element('canvas'));
const studio = new Studio(stage, settings, new WeightsError(element('legend')), say);
const readout = new Readout(element('readout'));
const headset = new Headset(stage, studio);
const history = new HistoryList(element('history'), (count) => studio.goBackTo(count));
let tool = tools[1];

function say(text, isFailure) {
  const said = element('said');
  said.textContent = text;
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
  element('clip').replaceChildren(...model.clips.map((clip, i) => new Option(clip.name || `Clip ${i + 1}`, i)));
  element('clip').disabled = element('play').disabled = element('seek').disabled = model.clips.length === 0;
  const [note] = model.notes.filter(({ kind }) => kind !== 'information');
  say(note ? `${name}: ${note.text}` : `${name}: ${model.meshCount} meshes, ${model.bones.length} bones, ${model.clips.length} clips`, false);
}
/** Opens a character that is not the page's own, and lists it beside those. */
async function openOther(bytes, name) {
  await open(bytes, name);
  let i = characters.findIndex((listed) => listed.name === name);
  if (i < 0) {
    i = characters.push({}) - 1;
    element('character').append(new Option(name, i));
  }
  characters[i] = { name, bytes };
  element('character').value = i;
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
for (const [i, { name }] of characters.entries()) element('character').append(new Option(name, i));
const openChosen = () => attempt(() => {
  const { name, glb, bytes = bytesOf(glb) } = characters[element('character').value];
  return open(bytes, name);
});
element('character').addEventListener('change', openChosen);
receiveFiles({ button: element('open'), input: element('file'), target: element('stage'), onFile: receive });

function togglePlay() {
  studio.isPlaying = !studio.isPlaying;
  studio.applySettings();
  element('play').textContent = studio.isPlaying ? 'Pause' : 'Play';
}
element('play').addEventListener('click', togglePlay);
element('clip').addEventListener('change', () => {
  studio.actor.play(Number(element('clip').value));
  studio.applySettings();
});
element('seek').addEventListener('input', () => { studio.actor.time = element('seek').value * studio.actor.duration; });
element('speed').addEventListener('change', () => { studio.speed = Number(element('speed').value); });

// ---- tools and settings ----

function choose(next) {
  tool = next;
  element('hint').textContent = tool.hint;
  element('stage').dataset.tool = tool.begin ? 'works' : 'turns';
  for (const input of element('tools').querySelectorAll('input')) input.checked = tools[input.value] === tool;
}
for (const [i, { name }] of tools.entries()) {
  const label = document.createElement('label'), input = Object.assign(document.createElement('input'), { type: 'radio', name: 'tool', value: i });
  input.addEventListener('change', () => choose(tools[i]));
  label.append(input, name);
  element('tools').append(label);
}
for (const name of ['width', 'depth', 'radius', 'tension']) {
  const input = element(name), shown = document.querySelector(`output[for=${name}]`);
  const apply = () => {
    settings[name] = Number(input.value);
    shown.textContent = `${(100 * settings[name]).toFixed(1)} %`;
    if (name === 'tension' && studio.actor) studio.applySettings();
  };
  input.addEventListener('input', apply);
  apply();
}
element('weights-error').addEventListener('change', ({ target }) => { studio.weightsError.isShown = target.checked; });
element('gives-way').addEventListener('change', ({ target }) => { settings.givesWay = target.checked; });

const canvas = element('canvas');
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

element('undo').addEventListener('click', () => studio.undo());
element('redo').addEventListener('click', () => studio.redo());
const saveLog = () => attempt(() => save(studio.actor.instance.log, `${studio.name}_ops.json`, 'application/json'));
const saveGLB = () => attempt(() => save(studio.actor.instance.toGLB(), `${studio.name}_torn.glb`, 'model/gltf-binary'));
element('save-log').addEventListener('click', saveLog);
element('save-glb').addEventListener('click', saveGLB);
element('save-snapshot').addEventListener('click', () => attempt(() => save(studio.saveState(), `${studio.name}.snapshot`)));
const fit = () => stage.show(studio.actor.box);
element('fit').addEventListener('click', fit);
element('help').addEventListener('click', () => element('helping').showModal());

const KEYS = { ' ': togglePlay, z: () => studio.undo(), y: () => studio.redo(), s: saveLog, g: saveGLB, f: fit, w: () => element('weights-error').click(), '?': () => element('helping').showModal() };
addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|BUTTON)$/.test(event.target.tagName) || !studio.actor) return;
  const act = KEYS[event.key.toLowerCase()] ?? (tools[event.key - 1] && (() => choose(tools[event.key - 1])));
  if (!act) return;
  event.preventDefault();
  act();
});

// ---- the headset ----

element('enter-vr').hidden = !await Headset.isThere();
element('enter-vr').addEventListener('click', () => attempt(async () => {
  if (headset.session) return headset.session.end();
  await headset.enter(() => { element('enter-vr').textContent = 'Enter VR'; });
  element('enter-vr').textContent = 'Leave VR';
}));

// ---- frames ----

let last = performance.now(), digest = null;
function frame(now) {
  const figures = studio.frame((now - last) / 1000, now / 1000);
  last = now;
  if (figures) {
    readout.add({ ...figures, memory: Sunder.memoryBytes });
    readout.others = studio.weightsError.lines;
    const { instance } = studio.actor, { undo, redo } = instance.undoCounts;
    element('undo').disabled = undo === 0;
    element('redo').disabled = redo === 0;
    history.update(instance);
    if (instance.digest !== digest) {
      digest = instance.digest;
      element('digest').textContent = undo === 0 ? 'Nothing is torn yet.' : `Digest ${digest.toString(16).padStart(16, '0')}`;
    }
    if (studio.actor.duration > 0) element('seek').value = (studio.actor.time % studio.actor.duration) / studio.actor.duration;
    document.body.dataset.operations = undo;
  }
  headset.show([...readout.lines, [element('said').textContent, '']]);
  stage.draw();
}

for (const name of Sunder.materialNames) element('tissue').append(new Option(name, name, name === settings.tissue, name === settings.tissue));
element('tissue').addEventListener('change', () => attempt(() => {
  settings.tissue = element('tissue').value;
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
  element('character').value = 0;
  await openChosen();
}
if (fault) say(fault, true);
stage.renderer.setAnimationLoop(frame);
/** For tests and for the console; frame(now) makes one. */
globalThis.studio = { studio, stage, readout, settings, tools, frame };
