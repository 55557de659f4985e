// What was asked of an instance, and what came of it in the update that did it.
import { Piece } from './piece.js';
import { SunderError } from './sunder_error.js';

export class Command {
  #promise = null;
  #settle = null;
  /** The Result, after the update that applied the command. */
  result = null;

  constructor(id) { this.id = id; }

  /** Resolves with the Result, or fails with its error. Made when it is first read, so that an ignored failure disturbs nobody. */
  get done() {
    this.#promise ??= new Promise((resolve, reject) => {
      this.#settle = (result) => (result.error ? reject(result.error) : resolve(result));
      if (this.result) this.#settle(this.result);
    });
    return this.#promise;
  }

  settle(result) {
    this.result = result;
    this.#settle?.(result);
  }
}

/** Of one command in one update. */
export class Result {
  constructor(calls, scene, instance, raw) {
    const { memory } = calls;
    this.command = raw.command;
    this.instance = instance;
    this.error = raw.status === 0 ? null : new SunderError(calls.sunder_status_name(raw.status), raw.status,
      raw.error_index === 0xFFFFFFFF ? null : raw.error_index, memory.text(raw.error));
    this.runs = raw.runs;
    this.segmentsMissed = raw.segments_missed;
    this.facesCrossed = raw.faces_crossed;
    this.verticesAdded = raw.vertices_added;
    this.trianglesAdded = raw.triangles_added;
    this.trianglesRetired = raw.triangles_retired;
    this.blocked = raw.blocked;
    this.caps = raw.caps;
    this.openSections = raw.open_sections;
    this.separatedPieces = raw.separated_pieces;
    this.length = raw.length;
    this.areaRemoved = raw.area_removed;
    /** What a detach took off. */
    this.piece = raw.has_piece ? new Piece(calls, calls.sunder_take_piece(scene, raw.command)) : null;
  }
}
