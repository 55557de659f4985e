// What an instance gives out to go on with: a stroke, a hold on tissue, a clip that plays.
import { blade, namesOf, triple } from './options.js';

/** A tear over several frames. */
export class Stroke {
  #submit;
  constructor(submit, begun) {
    this.#submit = submit;
    /** The Command that began it. */
    this.begun = begun;
  }
  /** The blade moves on. @returns its Command */
  extend(position, seconds) { return this.#submit('sunder_submit_extend_stroke', blade(position), seconds); }
  end() { return this.#submit('sunder_submit_end_stroke'); }
  cancel() { return this.#submit('sunder_submit_cancel_stroke'); }
}

/** A point of tissue that is pulled to a place. */
export class Hold {
  #call;
  #id;
  constructor(call, id) {
    this.#call = call;
    this.#id = id;
  }
  move(target) { this.#call('sunder_move_hold', this.#id, triple(target, 'target')); }
  release() { this.#call('sunder_release_hold', this.#id); }
}

/** A clip that plays. */
export class Layer {
  #call;
  #id;
  constructor(call, id) {
    this.#call = call;
    this.#id = id;
  }
  /** { isOver, time, weight }. */
  get state() { return namesOf(this.#call('sunder_get_layer', this.#id)); }
  fade(weight, seconds) { this.#call('sunder_fade_layer', this.#id, weight, seconds); }
  stop(seconds = 0) { this.#call('sunder_stop_layer', this.#id, seconds); }
  seek(time) { this.#call('sunder_seek_layer', this.#id, time); }
  set speed(speed) { this.#call('sunder_set_layer_speed', this.#id, speed); }
}
