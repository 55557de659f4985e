// The page of `sunder validate --html`: joins the data, the stage and the panels.
import { radiusOf } from '../../page_parts/src/bounds.js';
import { bytesOf, decode } from '../../page_parts/src/decode.js';
import { byId, html, setText, severitySign, visible } from '../../page_parts/src/elements.js';
import { listFindings, verdict } from './findings_list.js';
import { quantity } from '../../page_parts/src/format.js';
import { HeatPanel } from './heat_panel.js';
import { listenToKeys } from '../../page_parts/src/keys.js';
import { Markers } from './markers.js';
import { Models } from './models.js';
import { Player } from '../../page_parts/src/player.js';
import { Readout } from './readout.js';
import { Stage } from '../../page_parts/src/stage.js';
import { TimeBar } from '../../page_parts/src/time_bar.js';

const data = decode(bytesOf(byId('data').textContent));
const player = new Player(data);
const radius = Math.max(...[data.source, data.target].map(
  (model) => radiusOf(model.positions, model.indices)));
const stage = new Stage(byId('canvas'));
stage.setSize(radius);
const models = new Models(data, stage, player);
const readout = new Readout(byId('readout'), stage, () => models.viewports());
const markers = new Markers(byId('markers'), stage, (place) => models.poseOf(place));
const time = new TimeBar(data, player, { hint: 'A pose that was found; W', onPose: () => {
  models.setPose();
  readout.request();
} });
const heat = new HeatPanel(data, radius, {
  onShown: (shown, scale) => models.setShown(shown, scale),
  onWorst: (place, label) => flyTo(place, label),
});

function flyTo(place, label) {
  const { position, normal } = models.poseOf(place);
  markers.choose(place, label);
  const direction = normal ?? stage.camera.position.clone().sub(stage.controls.target).toArray();
  stage.goTo(position, direction, 0.9 * radius);
}

function fit() {
  const drawn = models.viewports().flat().map((shown) => shown.positions());
  stage.fit(drawn.flatMap((positions) => Array.from(positions)));
}

function showFinding(finding) {
  markers.choose(null);
  markers.show(finding?.places ?? [], finding?.severity, (i) => goToPlace(finding, i));
}

function goToPlace(finding, i) {
  flyTo(finding.places[i], quantity(finding.places[i].value, finding.unit));
}

function writeHeader() {
  const { worst, text } = verdict(data.findings);
  setText(byId('source-title'), data.source.title);
  setText(byId('target-title'), data.target.title);
  byId('verdict').append(...(worst ? [severitySign(worst)] : []), text);
  byId('verdict').className = worst ?? 'clean';
  document.title = visible(`${data.target.title}: ${text}`);
}

function arrange(layout) {
  models.arrange(layout);
  byId('stage').dataset.layout = layout;
  byId('captions').replaceChildren(...(layout === 'beside'
    ? [html('span', {}, 'Source'), html('span', {}, 'Target')]
    : [html('span', {}, 'Target, with the source as a ghost')]));
  fit();
}

function toggleBox(id, action) {
  byId(id).checked = !byId(id).checked;
  action(byId(id).checked);
}

function listen() {
  for (const input of document.querySelectorAll('input[name=layout]'))
    input.addEventListener('change', () => arrange(input.value));
  byId('bones').addEventListener('change', (event) => models.showBones(event.target.checked));
  byId('frame').addEventListener('click', fit);
  byId('help').addEventListener('click', () => byId('keys').showModal());
  listenToKeys(byId('canvas'), stage, {
    ' ': () => time.togglePlay(), ',': () => time.step(-1), '.': () => time.step(1),
    w: () => time.togglePose(0), n: () => heat.step(1), p: () => heat.step(-1),
    f: fit, h: () => heat.toggle(), l: () => heat.toggleLog(),
    b: () => toggleBox('bones', (isShown) => models.showBones(isShown)),
    v: () => document.querySelector('input[name=layout]:not(:checked)').click(),
    '?': () => byId('keys').showModal(),
  });
}

stage.beforeFrame = (now) => {
  if (!player.tick(now)) return;
  models.setPose();
  time.update();
};
stage.afterFrame = () => {
  markers.follow(models.targetView);
  if (player.isPlaying) stage.requestFrame();
};

writeHeader();
listFindings(byId('findings'), data.findings, data.target,
  { onOpen: showFinding, onPlace: goToPlace });
listen();
if (data.poses.length) time.togglePose(0);
arrange('beside');
// For scripts in the console of the browser, and for tests.
globalThis.sunder = { data, stage, models, player };
document.documentElement.dataset.ready = 'true';
