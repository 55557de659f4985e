// Instances that are updated together, once per frame.
import { sunder_restore_options, sunder_result, sunder_scene_options, sunder_spawn_options } from '../generated/calls.js';
import { Command, Result } from './command.js';
import { Instance } from './instance.js';
import { library } from './library.js';
import { takeBytes } from './made_bytes.js';
import { bytesOf, fieldsOf, namesOf } from './options.js';
import { Owned } from './owned.js';

export class Scene extends Owned {
  #instances = new Map();
  #commands = new Map();
  /** Counts what makes views invalid. */
  version = 0;
  /** What came of the commands that the last update applied. */
  results = [];

  constructor(options = {}) {
    const calls = library();
    super(calls.sunder_create_scene(fieldsOf(sunder_scene_options, options)), (handle) => {
      calls.sunder_destroy_scene(handle);
      calls.memory.detachViews();
    });
    this.calls = calls;
  }

  /** Views on the memory show something else from now on: none stays. */
  changed() {
    ++this.version;
    this.calls.memory.detachViews();
  }
  expect(id) {
    const command = new Command(id);
    this.#commands.set(id, command);
    return command;
  }
  forget(id) { this.#instances.delete(id); }

  /** An instance in the rest pose. */
  spawn(model, options = {}) {
    return this.adopt(this.calls.sunder_spawn(this.handle, model.asset, fieldsOf(sunder_spawn_options, options)), model);
  }
  /** The instance of an id, as one that restore() has made in a new scene. */
  adopt(id, model) {
    const instance = new Instance(this, id, model);
    this.#instances.set(id, instance);
    return instance;
  }
  /** Those that exist. */
  get instances() { return [...this.#instances.values()]; }

  /** Advances by a frame: samples clips, applies commands, steps tissue, poses what moved. @returns the results */
  update(seconds) {
    try {
      this.calls.sunder_update(this.handle, seconds);
    } finally {
      this.changed();
    }
    const { results, count } = this.calls.sunder_get_results(this.handle);
    this.results = this.calls.memory.readStructs(sunder_result, results, count).map((raw) =>
      new Result(this.calls, this.handle, this.#instances.get(raw.instance) ?? null, raw));
    for (const result of this.results) {
      this.#commands.get(result.command)?.settle(result);
      this.#commands.delete(result.command);
    }
    return this.results;
  }
  /** The instances that the last update posed anew. */
  get drawn() {
    const { instances, count } = this.calls.sunder_get_drawn(this.handle);
    return this.calls.memory.u64s(instances, count).map((id) => this.#instances.get(id)).filter(Boolean);
  }
  /** Figures of the last update; times in microseconds. */
  get stats() { return namesOf(this.calls.sunder_get_frame_stats(this.handle)); }
  setBudget({ settledPoints = 0xFFFFFFFF, modelWork = 0xFFFFFFFF } = {}) { this.calls.sunder_set_budget(this.handle, settledPoints, modelWork); }

  /** The state of all instances, without their models. */
  save() { return takeBytes(this.calls, this.calls.sunder_save_scene(this.handle)); }
  /** Goes back to what was saved; the bytes are not trusted. @param models  those of the instances. Instances that are gone then are forgotten. */
  restore(snapshot, models, options = {}) {
    try {
      this.calls.sunder_restore_scene(this.handle, bytesOf(snapshot), Uint32Array.from(models, (model) => model.asset), models.length,
        fieldsOf(sunder_restore_options, options));
    } finally {
      this.changed();
    }
    this.#commands.clear();
    for (const instance of this.instances) if (!instance.exists) this.forget(instance.id);
  }
}
