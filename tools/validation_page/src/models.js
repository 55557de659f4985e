// Both models on the stage, side by side or one over the other.
import { BoneLines } from '../../page_parts/src/bone_lines.js';
import { poseNormal, posePositions, poseVertices } from '../../page_parts/src/skin.js';
import { Surface } from './surface.js';

const CLAY = { light: [0.80, 0.79, 0.77], dark: [0.58, 0.59, 0.61] };
const GHOST = { light: [0.15, 0.35, 0.75], dark: [0.65, 0.80, 1.0] };
const BACKGROUND = { light: [0.955, 0.957, 0.962], dark: [0.135, 0.145, 0.165] };
const BONE = [1, 0.58, 0.1];
const CHOSEN_BONE = [1, 0.18, 0.57];

export class Models {
  constructor(data, stage, player) {
    this.data = data;
    this.stage = stage;
    this.player = player;
    this.source = new Surface(data.source);
    this.target = new Surface(data.target);
    this.bones = new BoneLines(data.skeleton.parents);
    this.layout = 'beside';
    this.posed = {};
    this.dark = matchMedia('(prefers-color-scheme: dark)');
    this.dark.addEventListener('change', () => this.paint());
    this.arrange('beside');
    this.setPose();
  }

  /** @param layout  'beside' or 'overlaid' */
  arrange(layout) {
    this.layout = layout;
    const bones = this.bones.objects;
    const beside = layout === 'beside';
    this.stage.setViews(beside
      ? [[this.source.mesh, ...bones], [this.target.mesh, ...bones]]
      : [[this.target.mesh, this.source.mesh, ...bones]]);
    this.source.setGhost(!beside);
    this.paint();
  }

  paint() {
    const theme = this.dark.matches ? 'dark' : 'light';
    this.stage.background.setRGB(...BACKGROUND[theme]);
    this.target.setClay(...CLAY[theme]);
    this.source.setClay(...(this.layout === 'beside' ? CLAY : GHOST)[theme]);
    this.source.setValues(this.layout === 'beside' ? this.shown?.source ?? null : null);
    this.bones.select(this.shown?.bone, BONE, CHOSEN_BONE);
    this.stage.requestFrame();
  }

  /** @param shown  of heat.js; null: plain */
  setShown(shown, scale) {
    this.shown = shown;
    this.target.setValues(shown?.target ?? null);
    for (const surface of [this.source, this.target])
      if (shown) surface.setScale(scale, shown.threshold);
    this.paint();
  }

  /** Takes over the pose of the player. */
  setPose() {
    this.source.setPose(this.player.source);
    this.target.setPose(this.player.target);
    this.bones.setPose(this.player.bones);
    this.posed = {};
    this.stage.requestFrame();
  }

  showBones(isShown) {
    this.bones.show(isShown);
    this.stage.requestFrame();
  }

  get targetView() {
    return this.layout === 'beside' ? 1 : 0;
  }

  /** For the read-out; positions are computed when asked for. */
  viewports() {
    const entry = (role, name) => ({
      role, model: this.data[name], values: this.shown?.[name] ?? null, unit: this.shown?.unit,
      positions: () => (this.posed[name] ??= posePositions(this.data[name], this.player[name])),
    });
    const target = entry('Target', 'target');
    return this.layout === 'beside' ? [[entry('Source', 'source')], [target]] : [[target]];
  }

  /** A place of a finding in the current pose. */
  poseOf(place) {
    if (place.vertex === null) return { position: place.position, normal: null };
    const vertex = this.vertexOf(place);
    const { data: { target }, player } = this;
    return { position: [...poseVertices(target, player.target, [vertex])],
      normal: poseNormal(target, player.target, vertex) };
  }

  vertexOf(place) {
    return place.vertex + (this.data.target.meshes[place.mesh]?.first_vertex ?? 0);
  }
}
