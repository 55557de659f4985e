// The page of `sunder view`: joins the data, the stage, the tools and the list of operations.
import { Color } from 'three';
import { BoneLines } from '../../page_parts/src/bone_lines.js';
import { bytesOf, decode, NONE } from '../../page_parts/src/decode.js';
import { byId, setText, visible } from '../../page_parts/src/elements.js';
import { listenToKeys } from '../../page_parts/src/keys.js';
import { Player } from '../../page_parts/src/player.js';
import { posePositions } from '../../page_parts/src/skin.js';
import { Stage } from '../../page_parts/src/stage.js';
import { TimeBar } from '../../page_parts/src/time_bar.js';
import { boxOf } from '../../page_parts/src/bounds.js';
import { followBones } from './bone_names.js';
import { givePose } from './given_pose.js';
import { History } from './history.js';
import { Limbs } from './limbs.js';
import { isPlaced, isSamePose, parseLog, poseSpec, shellWord } from './log.js';
import { OperationList } from './operation_list.js';
import { Overlays } from './overlays.js';
import { PosedSurface } from './picking.js';
import { Placing } from './placing.js';
import { openedLines } from './preview.js';
import { Settings } from './settings.js';
import { decodeImages, PIECES, ShownModel } from './shown_model.js';
import { listTornFacts } from './torn_facts.js';
import { add, scaled } from './vectors.js';

const CLAY = { light: [0.80, 0.79, 0.77], dark: [0.58, 0.59, 0.61] };
const BACKGROUND = { light: [0.955, 0.957, 0.962], dark: [0.135, 0.145, 0.165] };
const BONE = [1, 0.58, 0.1];
const CHOSEN_BONE = [1, 0.18, 0.57];

class Page {
  constructor(data, bitmaps) {
    this.data = data;
    this.player = new Player(data);
    this.which = data.target ? 'target' : 'source';
    this.posed = {};
    const { least, most } = boxOf(this.positions('source'), data.source.indices);
    this.diagonal = Math.hypot(...add(most, least, -1)) || 1;
    this.makePicture(bitmaps, scaled(add(least, most), 0.5));
    this.makePanels();
    this.listen();
    this.paint();
    this.show(this.which);
    this.fit();
  }

  makePicture(bitmaps, centre) {
    const { data } = this;
    this.stage = new Stage(byId('canvas'));
    this.stage.setSize(this.diagonal / 2);
    this.uniforms = { showsColours: { value: true }, clay: { value: new Color() },
      pieceColours: { value: PIECES.map((colour) => new Color().setStyle(colour, 'srgb-linear')) } };
    this.models = { source: new ShownModel(data.source, bitmaps, this.uniforms) };
    if (data.target) this.models.target = new ShownModel(data.target, bitmaps, this.uniforms);
    this.boneLines = new BoneLines(data.skeleton.parents);
    this.overlays = new Overlays(centre, 0.55 * this.diagonal);
    this.dark = matchMedia('(prefers-color-scheme: dark)');
  }

  makePanels() {
    const { data, player } = this;
    document.title = visible(
      data.target ? `${data.source.title} → ${data.target.title}` : data.source.title);
    setText(byId('title'), document.title);
    byId('which').hidden = byId('torn').hidden = !data.target;
    if (data.target) listTornFacts(byId('torn-facts'), data.target);
    byId('poses').setAttribute('aria-label', 'Poses without a clip');
    this.time = new TimeBar(data, player,
      { hint: 'Pose without a clip', onPose: () => this.setPose() });
    this.history = new History(parseLog(data.operations), () => this.operationsChanged());
    const say = (text, hasFailed) => this.say(text, hasFailed);
    const name = `${data.source.title.replace(/\.[^.]*$/, '') || 'model'}_ops.json`;
    setText(byId('command'),
      `sunder tear ${shellWord(data.source.title)} --ops ${shellWord(name)} -o torn.glb`);
    this.list = new OperationList(this.history, name,
      { onMessage: say, onChoose: (operation) => this.choose(operation) });
    this.settings = new Settings(byId('settings'), this.diagonal, () => this.placing?.update());
    this.placing = new Placing(byId('canvas'), this.settings, {
      pick: (x, y) => this.pick(x, y), surface: () => this.surface(),
      pose: () => poseSpec(data, player), rig: () => this.rig(),
      isSource: () => this.which === 'source', onMessage: say,
      onPending: (places, operation) => {
        this.overlays.setPending(places);
        this.possible = operation;
        this.updateOpened();
      },
      onOperation: (operation) => {
        this.history.append(operation);
        say(`Operation ${this.history.operations.length} is in the list.`);
      },
    });
    this.operationsChanged();
  }

  say(text, hasFailed = false) {
    setText(byId('said'), text);
    byId('said').classList.toggle('failed', hasFailed);
  }

  positions(which) {
    return this.posed[which] ??= posePositions(this.data[which], this.player[which]);
  }

  /** What is shown, in the pose that is shown. */
  surface() {
    const { which } = this;
    return new PosedSurface(this.data[which], this.player[which], this.positions(which));
  }

  pick(x, y) {
    if (this.player.isPlaying) this.time.togglePlay();
    const { origin, direction } = this.stage.rayAt(x, y);
    const found = this.surface().hit(origin, direction);
    return found && { ...found, eye: origin };
  }

  /** The bones in the pose that is shown, and which surface they move. */
  rig() {
    this.limbs ??= new Limbs(this.data.source, this.data.skeleton.parents);
    return { limbs: this.limbs, bones: this.player.bones };
  }

  /** Draws where the operations of this pose, and the one that is being placed, would open the source. */
  updateOpened() {
    const isShown = this.which === 'source' && !this.player.isPlaying;
    const here = isShown ? this.history.operations.filter((operation) => this.isHere(operation)) : [];
    if (isShown && this.possible) here.push(this.possible);
    this.opened = here.flatMap((operation) => openedLines(operation, this.surface(), this.rig()));
    this.overlays.setOpened(this.opened);
    this.stage.requestFrame();
  }

  /** Takes over the pose of the player. */
  setPose() {
    this.posed = {};
    for (const [which, model] of Object.entries(this.models)) model.setPose(this.player[which]);
    this.boneLines.setPose(this.player.bones);
    this.placing.poseChanged();
    this.updateOverlays();
    this.stage.requestFrame();
  }

  isHere(operation) {
    return isSamePose(this.data, operation.pose, poseSpec(this.data, this.player));
  }

  stateOf(i) {
    const operation = this.history.operations[i];
    if (operation === this.list.chosen) return 'chosen';
    return this.isHere(operation) ? 'here' : 'elsewhere';
  }

  updateOverlays() {
    this.overlays.setStates((i) => this.stateOf(i));
    this.updateOpened();
  }

  operationsChanged() {
    this.list.update();
    this.overlays.setOperations(this.history.operations, (i) => this.stateOf(i));
    this.updateOpened();
  }

  /** Goes to the pose of an operation. */
  choose(operation) {
    this.updateOverlays();
    this.stage.requestFrame();
    if (!operation || !isPlaced(operation)) return;
    const problem = givePose(this.data, this.player, operation.pose ?? 'rest');
    if (problem) return this.say(problem, true);
    this.time.change(() => this.player.play(false));
  }

  /** @param which  'source' or 'target' */
  show(which) {
    this.which = which;
    document.querySelector(`input[name=which][value=${which}]`).checked = true;
    this.stage.setViews([[...this.models[which].objects, ...this.boneLines.objects,
      ...this.overlays.objects]]);
    this.setPose();
  }

  paint() {
    const theme = this.dark.matches ? 'dark' : 'light';
    this.stage.background.setRGB(...BACKGROUND[theme]);
    this.uniforms.clay.value.setRGB(...CLAY[theme]);
    this.boneLines.select(this.bone ?? NONE, BONE, CHOSEN_BONE);
    this.stage.requestFrame();
  }

  fit() {
    this.stage.fit(this.positions(this.which));
  }

  listen() {
    const { stage, player } = this;
    this.dark.addEventListener('change', () => this.paint());
    for (const input of document.querySelectorAll('input[name=which]'))
      input.addEventListener('change', () => this.show(input.value));
    byId('bones').addEventListener('change', (event) => this.showBones(event.target.checked));
    byId('colours').addEventListener('change', (event) => this.showColours(event.target.checked));
    byId('frame').addEventListener('click', () => this.fit());
    byId('help').addEventListener('click', () => byId('keys').showModal());
    followBones(byId('readout'), byId('canvas'), this.data.source.bones,
      () => byId('bones').checked && { bones: player.bones, parents: this.data.skeleton.parents,
        placeOf: (position) => stage.placeOf(position, 0) },
      (bone) => this.pointAtBone(bone));
    stage.beforeFrame = (now) => {
      if (!player.tick(now)) return;
      this.setPose();
      this.time.update();
    };
    stage.afterFrame = () => {
      if (player.isPlaying) stage.requestFrame();
    };
    this.listenToKeys();
  }

  listenToKeys() {
    const { stage, time, placing, history } = this;
    const click = (id) => () => byId(id).click();
    const tools = ['look', 'tear', 'cut', 'drill', 'limb', 'incision'];
    listenToKeys(byId('canvas'), stage, {
      ' ': () => time.togglePlay(), ',': () => time.step(-1), '.': () => time.step(1),
      ...Object.fromEntries(tools.map((tool, i) => [String(i + 1), () => placing.choose(tool)])),
      Enter: () => placing.finish(), Backspace: () => placing.back(), Escape: () => placing.drop(),
      z: () => (placing.clicks.length ? placing.back() : history.step(-1)),
      y: () => history.step(1), s: click('save'), b: click('bones'), c: click('colours'),
      o: () => this.toggleOverlays(), f: () => this.fit(), '?': click('help'),
      t: () => this.data.target && this.show(this.which === 'source' ? 'target' : 'source'),
    });
  }

  pointAtBone(bone) {
    if (this.bone === bone) return;
    this.bone = bone;
    this.paint();
  }

  showBones(isShown) {
    this.boneLines.show(isShown);
    this.stage.requestFrame();
  }

  showColours(isShown) {
    this.uniforms.showsColours.value = isShown;
    this.stage.requestFrame();
  }

  toggleOverlays() {
    const { group, opened } = this.overlays;
    group.visible = opened.visible = !group.visible;
    this.stage.requestFrame();
  }
}

async function start() {
  const data = decode(bytesOf(byId('data').textContent));
  const bitmaps = await decodeImages(data);
  const page = new Page(data, bitmaps);
  const failed = bitmaps.filter((bitmap) => !bitmap).length;
  if (failed) page.say(`This browser cannot decode ${failed} of the images.`, true);
  // For scripts in the console of the browser, and for tests.
  globalThis.sunder = page;
  document.documentElement.dataset.ready = 'true';
}

start().catch((error) => globalThis.showError(`This page cannot be shown: ${error.message}`));
