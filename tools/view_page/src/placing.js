// Clicks that become operations: which tool is chosen, and the points that it has.
import { byId, setText } from '../../page_parts/src/elements.js';
import { makeAimed, makeBore, makeCut, makeIncision, makeTear } from './operations.js';

const CLICK = 5;  // pixels; further is a drag

const HINTS = {
  look: () => 'Choose a tool to place an operation in the pose that is shown.',
  tear: (count) => (count < 2 ? `Click along the surface: ${count ? 'the next' : 'the first'} point.`
    : `${count} points. Click on, or Finish.`),
  cut: (count, { by }) => `Click point ${count + 1} of ${by === 'sight' ? 2 : 3} on the model.`,
  drill: () => 'Click where the axis of the bore enters.',
  limb: (count, { what }) => `Click the limb to ${what}: the bone that moves the place counts.`,
  incision: (count) => (count < 2 ? `Click along the surface: ${count ? 'the next' : 'the first'} point.`
    : `${count} points of the surface. Click on, or Finish.`),
};

/** The clicks that an operation needs; strokes and incisions end by Finish. */
const needed = (tool, { by }) => ({ cut: by === 'sight' ? 2 : 3, drill: 1, limb: 1 })[tool];
const LEAST = { tear: 2, cut: 2, drill: 1, limb: 1, incision: 2 };
const MAKE = { tear: makeTear, cut: makeCut, drill: makeBore, limb: makeAimed, incision: makeIncision };
/** Tools that name bones or triangles of the source. */
const OF_SOURCE = ['limb', 'incision'];

export class Placing {
  /**
   * @param pick  (x, y) -> {position, normal, eye} or null; @param surface  () -> PosedSurface
   * @param pose  () -> the pose that is shown, as a log says it; @param rig  () -> {limbs, bones}
   * @param isSource  () -> whether the source is shown
   * @param onPending  (places, operation) with the operation that Finish would make, or null
   */
  constructor(canvas, settings,
    { pick, surface, pose, rig, isSource, onPending, onOperation, onMessage }) {
    Object.assign(this, { settings, pick, surface, pose, rig, isSource, onPending, onOperation, onMessage });
    this.clicks = [];
    for (const input of document.querySelectorAll('input[name=tool]'))
      input.addEventListener('change', () => this.choose(input.value));
    byId('finish').addEventListener('click', () => this.finish());
    byId('back').addEventListener('click', () => this.back());
    byId('cancel').addEventListener('click', () => this.drop());
    this.listen(canvas);
    this.choose('look');
  }

  listen(canvas) {
    let down = null;
    canvas.addEventListener('pointerdown', (event) => {
      down = event.isPrimary && event.button === 0 ? [event.offsetX, event.offsetY] : null;
    });
    canvas.addEventListener('pointerup', (event) => {
      const place = [event.offsetX, event.offsetY];
      if (down && Math.hypot(place[0] - down[0], place[1] - down[1]) < CLICK) this.click(...place);
      down = null;
    });
    canvas.addEventListener('pointercancel', () => { down = null; });
  }

  choose(tool) {
    this.tool = tool;
    document.querySelector(`input[name=tool][value=${tool}]`).checked = true;
    byId('stage').dataset.tool = tool === 'look' ? 'look' : 'place';
    this.settings.show(tool);
    this.drop();
  }

  click(x, y) {
    if (this.tool === 'look') return;
    if (OF_SOURCE.includes(this.tool) && !this.isSource())
      return this.onMessage('Show the source: the log names its bones and triangles.', true);
    const place = this.pick(x, y);
    if (!place) return this.onMessage('There is no surface at this place.', true);
    this.onMessage('');
    this.clicks.push(place);
    this.update();
    if (this.clicks.length === needed(this.tool, this.settings.current)) this.finish();
  }

  /** The operation through the clicks so far. Throws a text if there is none. */
  make() {
    return MAKE[this.tool](this.clicks, this.settings.current, this.pose(), this.surface(), this.rig());
  }

  /** Makes the operation; points that say none are dropped. */
  finish() {
    if (this.clicks.length < LEAST[this.tool]) return;
    try {
      this.onOperation(this.make());
    } catch (error) {
      this.onMessage(error.message, true);
    }
    this.drop();
  }

  /** What Finish would make; null if it would make nothing. */
  possible() {
    if (this.clicks.length < LEAST[this.tool]) return null;
    try {
      return this.make();
    } catch {
      return null;
    }
  }

  back() {
    this.clicks.pop();
    this.update();
  }

  drop() {
    this.clicks = [];
    this.update();
  }

  /** The points of one operation lie on the surface of one pose. */
  poseChanged() {
    if (!this.clicks.length) return;
    this.drop();
    this.onMessage('The pose has changed: the points were dropped.', true);
  }

  update() {
    const count = this.clicks.length;
    setText(byId('hint'), HINTS[this.tool](count, this.settings.current));
    const isOpenEnded = ['tear', 'incision'].includes(this.tool);
    byId('pending').hidden = !isOpenEnded && this.tool !== 'cut';
    byId('finish').hidden = !isOpenEnded;
    byId('finish').disabled = count < 2;
    byId('back').disabled = byId('cancel').disabled = count === 0;
    this.onPending(this.clicks.map(({ position }) => position), isOpenEnded ? this.possible() : null);
  }
}
