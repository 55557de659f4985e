// The character, what is done to it, and one frame after the other.
import { Actor } from './actor.js';
import { Sunder } from 'sunder-tear';
import { FallingPiece } from './falling_piece.js';
import { PaintHistory } from './paint_history.js';
import { packState, unpackState } from './state_file.js';

export class Studio {
  #stage;
  #settings;
  #onMessage;
  #pieces = [];
  #use = null;
  /** By the command of a tool: what is said once it is done. */
  #says = new Map();
  #paints = new PaintHistory();
  /** Ends when the strokes of the brush so far are in the tissue. */
  painted = Promise.resolve();
  /** The tool that is chosen. */
  tool = null;
  actor = null;
  name = '';
  isPlaying = true;
  /** Colours the character, or not. */
  weightsError;
  paintedColours;
  /** What else acts on the character in each frame: { act, feel, dispose }. */
  hands = [];
  get fallen() { return this.#pieces; }
  speed = 1;

  /**
   * @param settings  { width, depth, radius, tension, tissue, givesWay; field, factor, erases of the brush }
   * @param colours  { weightsError, paintedColours }
   * @param onMessage  gets what an operation did, and whether it failed
   */
  constructor(stage, settings, { weightsError, paintedColours }, onMessage) {
    this.weightsError = weightsError;
    this.paintedColours = paintedColours;
    this.#stage = stage;
    this.#settings = settings;
    this.#onMessage = onMessage;
  }

  /** Shows another character. What is shown stays if the file is refused. */
  async open(bytes, name) {
    const actor = await Actor.create(bytes, this.#settings.tissue);
    this.close();
    this.actor = actor;
    this.name = name;
    this.#stage.world.add(actor.object);
    this.#stage.show(actor.box);
    this.applySettings();
  }
  close() {
    this.#use = null;
    this.#says.clear();
    this.#dropPieces(() => true);
    this.#clearColours();
    this.#paints.clear();
    this.actor?.dispose();
    this.actor = null;
  }
  applySettings() {
    this.actor.setTension(this.#settings.tension);
    this.actor.isPlaying = this.isPlaying;
  }

  // ---- tools ----

  /** Begins a tool. @returns whether it takes the drag */
  begin(tool, event) {
    const { actor } = this, ray = this.#stage.ray(event), hit = actor?.hit(ray);
    if (!actor || !tool.begin || (tool.needsHit && !hit)) return false;
    this.#useTool(() => { this.#use = tool.begin({ actor, ray, hit, settings: this.#settings, time: event.timeStamp / 1000 }); });
    if (this.#use?.says) this.#says.set(this.#use.command.id, this.#use.says);
    return true;
  }
  move(event) {
    if (!this.#use) return;
    const ray = this.#stage.ray(event);
    this.#useTool(() => this.#use.move({ ray, hit: this.actor.hit(ray), time: event.timeStamp / 1000 }));
  }
  end() {
    const use = this.#use;
    this.#use = null;
    if (!use) return;
    this.#attempt(() => {
      const done = use.end();
      if (use.stroke) this.#paint(done);
    });
  }
  /** The last operation or stroke of the brush, whichever came later. */
  undo() {
    this.#attempt(() => {
      const { instance } = this.actor, { undo } = instance.undoCounts, paint = this.#paints.undo(undo);
      if (paint) this.#repaint(paint);
      else if (undo > 0) instance.undo();
    });
  }
  redo() {
    this.#attempt(() => {
      const { instance } = this.actor, { undo, redo } = instance.undoCounts, paint = this.#paints.redo(undo);
      if (paint) this.#repaint(paint);
      else if (redo > 0) instance.redo();
    });
  }
  get canUndo() { return this.actor.instance.undoCounts.undo > 0 || this.#paints.canUndo; }
  get canRedo() { return this.actor.instance.undoCounts.redo > 0 || this.#paints.canRedo; }
  #paint({ fields, text }) {
    const { actor } = this;
    this.#paints.add({ before: this.#paints.fields ?? actor.fields, after: fields, operations: actor.instance.undoCounts.undo });
    this.#repaint(fields);
    this.#onMessage(text[0].toUpperCase() + text.slice(1), false);
  }
  /** One after the other, because a model is made for each. */
  #repaint(fields) {
    const { actor } = this;
    this.painted = this.painted.then(async () => {
      if (actor !== this.actor) return;
      this.#use = null;
      this.#says.clear();
      this.#clearColours();
      await actor.repaint(fields);
      this.applySettings();
    }).catch((error) => this.#onMessage(error.message, true));
  }
  /** They are drawn from buffers of the character's meshes. */
  #clearColours() {
    this.weightsError.clear();
    this.paintedColours.clear();
  }
  /** Undoes until so many operations are left. */
  goBackTo(count) {
    this.#attempt(() => { for (let i = this.actor.instance.undoCounts.undo; i > count; --i) this.actor.instance.undo(); });
  }
  /** Does the operations of a log, after those that are done. @returns how many */
  replay(log) { return this.actor.instance.applyLog(log); }

  /** The character, and where its fallen parts are. */
  saveState() { return packState({ snapshot: this.actor.tissue.save(), pieces: this.#pieces.map(({ state }) => state) }); }
  /** Goes back to what was saved of the same character. Nothing changes if it is refused. */
  async restoreState(bytes) {
    const { actor } = this, { snapshot, pieces } = unpackState(bytes), models = [];
    try {
      for (const { glb } of pieces) models.push(await Sunder.load(glb, { soft: false }));
      if (actor !== this.actor) throw new Error('another character was opened meanwhile');
      actor.tissue.restore(snapshot, [actor.model]);
      actor.blood.restart();
    } catch (error) {
      for (const model of models) model.dispose();
      throw error;
    }
    this.#use = null;
    this.#dropPieces(() => true);
    pieces.forEach((piece, i) => this.#add(new FallingPiece(models[i], { ...piece, actor })));
    actor.parts.update(0);
  }

  /** @returns whether it worked */
  #attempt(action) {
    try {
      action();
      return true;
    } catch (error) {
      this.#onMessage(error.message, true);
      return false;
    }
  }
  #useTool(action) { if (!this.#attempt(action)) this.#use = null; }

  // ---- frames ----

  /** @param now  seconds, which the hands' tears get @returns the figures of the frame */
  frame(seconds, now = performance.now() / 1000) {
    const { actor } = this;
    if (!actor) return null;
    const began = performance.now(), dt = Math.max(0, Math.min(seconds, 0.05)) * this.speed;
    for (const hand of this.hands) this.#attempt(() => hand.act({ actor, settings: this.#settings, seconds: now }));
    this.#handle(actor.tissue.update(dt));
    if (this.#use?.frame) this.#useTool(() => this.#use.frame());
    for (const hand of this.hands) this.#attempt(() => hand.feel({ actor, settings: this.#settings }));
    const { stats } = actor.tissue, updated = performance.now();
    actor.object.update();
    actor.blood.update();
    actor.stitches.update();
    let bytes = actor.object.uploadedBytes;
    for (const piece of this.#pieces) {
      piece.drawn.update();
      piece.step(dt, this.#stage.floorHeight);
      bytes += piece.drawn.uploadedBytes;
    }
    this.#dropUndone();
    actor.inside.isShown = actor.isTearing || actor.instance.undoCounts.undo > 0;
    const ended = performance.now();
    this.#attempt(() => this.#colour(actor));
    return { ...stats, own: ended - began, upload: ended - updated, bytes };
  }

  /** One field at a time: what is painted, while it is; else the weights' error. */
  #colour(actor) {
    if (this.tool?.paints && this.weightsError.report) this.weightsError.clear();
    this.paintedColours.update(actor, this.tool?.paints ? this.#settings.field : null, this.#use?.stroke ?? null);
    if (!this.tool?.paints) this.weightsError.update(actor, this.#use !== null || actor.isTearing);
  }

  #handle(results) {
    const before = this.#pieces.length;
    for (const result of results) {
      if (result.error) this.#onMessage(result.error.message, true);
      else if (result.piece) this.#letFall(result.piece);
      else if (result.facesCrossed > 0 || result.separatedPieces > 0) {
        const parts = result.separatedPieces > 0 ? `; ${result.separatedPieces} part${result.separatedPieces > 1 ? 's' : ''} came free` : '';
        this.#onMessage(`${result.facesCrossed} faces torn${parts}`, false);
      } else if (this.#says.has(result.command)) this.#onMessage(this.#says.get(result.command)(result), false);
      this.#says.delete(result.command);
    }
    if (this.#pieces.length > before) this.actor.parts.update(0);  // poses them for this frame
  }

  #letFall(piece) {
    const { actor } = this, { mass, inertiaPiece, modelFromPiece } = piece.info;
    this.#add(new FallingPiece(piece.toModel({ soft: false }), { actor, operations: actor.instance.undoCounts.undo, body: { mass, inertiaPiece, modelFromPiece } }));
    piece.dispose();
    this.#onMessage('A part falls', false);
  }
  #add(fallen) {
    this.#pieces.push(fallen);
    this.#stage.world.add(fallen.object);
  }
  /** A piece whose detach is undone is a part of the character again. */
  #dropUndone() {
    const done = this.actor.instance.undoCounts.undo;
    this.#dropPieces(({ operations }) => operations > done);
  }
  #dropPieces(isGone) {
    for (const piece of this.#pieces.filter(isGone)) piece.dispose();
    this.#pieces = this.#pieces.filter((piece) => !isGone(piece));
  }
}
