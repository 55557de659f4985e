// The character, what is done to it, and one frame after the other.
import { Actor } from './actor.js';
import { FallingPiece } from './falling_piece.js';

export class Studio {
  #stage;
  #settings;
  #onMessage;
  #pieces = [];
  #use = null;
  actor = null;
  name = '';
  isPlaying = true;
  /** What else acts on the character in each frame: { act, feel, dispose }. */
  hands = [];
  get fallen() { return this.#pieces; }
  speed = 1;

  /**
   * @param settings  { width, depth, radius, tension, tissue, givesWay }
   * @param onMessage  gets what an operation did, and whether it failed
   */
  constructor(stage, settings, onMessage) {
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
    for (const piece of this.#pieces) piece.dispose();
    this.#pieces = [];
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
    if (use) this.#attempt(() => use.end());
  }
  undo() { this.#attempt(() => { if (this.actor.instance.undoCounts.undo > 0) this.actor.instance.undo(); }); }
  redo() { this.#attempt(() => { if (this.actor.instance.undoCounts.redo > 0) this.actor.instance.redo(); }); }
  /** Undoes until so many operations are left. */
  goBackTo(count) {
    this.#attempt(() => { for (let i = this.actor.instance.undoCounts.undo; i > count; --i) this.actor.instance.undo(); });
  }
  /** Does the operations of a log, after those that are done. @returns how many */
  replay(log) { return this.actor.instance.applyLog(log); }

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
    let bytes = actor.object.uploadedBytes;
    for (const piece of this.#pieces) {
      piece.drawn.update();
      piece.step(dt, this.#stage.floorHeight);
      bytes += piece.drawn.uploadedBytes;
    }
    this.#dropUndone();
    const ended = performance.now();
    return { ...stats, own: ended - began, upload: ended - updated, bytes };
  }

  #handle(results) {
    const before = this.#pieces.length;
    for (const result of results) {
      if (result.error) this.#onMessage(result.error.message, true);
      else if (result.piece) this.#letFall(result.piece);
      else if (result.facesCrossed > 0 || result.separatedPieces > 0) {
        const parts = result.separatedPieces > 0 ? `; ${result.separatedPieces} part${result.separatedPieces > 1 ? 's' : ''} came free` : '';
        this.#onMessage(`${result.facesCrossed} faces torn${parts}`, false);
      }
    }
    if (this.#pieces.length > before) this.#handle(this.actor.tissue.update(0));  // poses the new pieces for this frame
  }

  #letFall(piece) {
    const { tissue, instance, gltf, size, model } = this.actor;
    const fallen = new FallingPiece(piece, { tissue, of: model, gltf, operations: instance.undoCounts.undo, size });
    this.#pieces.push(fallen);
    this.#stage.world.add(fallen.object);
    this.#onMessage('A part falls', false);
  }
  /** A piece whose detach is undone is a part of the character again. */
  #dropUndone() {
    const done = this.actor.instance.undoCounts.undo;
    for (const piece of this.#pieces.filter(({ operations }) => operations > done)) piece.dispose();
    this.#pieces = this.#pieces.filter(({ operations }) => operations <= done);
  }
}
