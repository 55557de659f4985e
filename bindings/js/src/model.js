// A rigged model, and what its instances share.
import { sunder_asset_options, sunder_bone, sunder_clip, sunder_load_options, sunder_mesh, sunder_note, sunder_perforation, sunder_save_options, sunder_skin, sunder_tissue_field, sunder_transform } from '../generated/calls.js';
import { characterData } from './character_arrays.js';
import { library } from './library.js';
import { takeBytes } from './made_bytes.js';
import { materialOf } from './materials.js';
import { MeshData } from './mesh_data.js';
import { bytesOf, fieldsOf, triple } from './options.js';
import { Owned } from './owned.js';
import { Ragdoll } from './ragdoll.js';
import { invalidArgument } from './sunder_error.js';

const NOTES = ['information', 'repaired', 'dropped', 'warning'];

const factorsOf = (one) => fieldsOf(sunder_tissue_field, { ...one, valueCount: one.values?.length ?? 0 });
const placeOf = (one) => ({ ...one, barycentric: triple(one.barycentric, 'barycentric of a place') });
const perforationOf = ({ places = [], ...others }) => fieldsOf(sunder_perforation, { ...others, places: places.map(placeOf), placeCount: places.length });

/** `soft`: false, true, a material's name or an object; `materials`: several of them. `fields`: factors per vertex,
 * { mesh, field: 'toughness', values }; `perforations`: weak lines, { places: [{ mesh, triangle, barycentric }], strength }. */
function assetFields(calls, { soft = true, material, materials, fields: factors = [], perforations = [], ...others }) {
  const list = materials ?? [material ?? (typeof soft === 'string' || typeof soft === 'object' ? soft : null)].filter(Boolean);
  const fields = fieldsOf(sunder_asset_options, others);
  fields.is_soft = soft ? 1 : 0;
  if (list.length) Object.assign(fields, { materials: list.map((one) => materialOf(calls, one)), material_count: list.length });
  if (factors.length) Object.assign(fields, { fields: factors.map(factorsOf), field_count: factors.length });
  if (perforations.length) Object.assign(fields, { perforations: perforations.map(perforationOf), perforation_count: perforations.length });
  return fields;
}

export class Model extends Owned {
  #calls;
  #asset = 0;

  constructor(calls, character, options) {
    const handles = { asset: 0 };
    super(character, () => {
      if (handles.asset) calls.sunder_destroy_asset(handles.asset);
      calls.sunder_destroy_character(character);
      calls.memory.detachViews();
    });
    this.#calls = calls;
    try {
      handles.asset = this.#asset = calls.sunder_create_asset(character, assetFields(calls, options));
    } catch (error) {
      this.dispose();
      throw error;
    }
  }

  static fromGLB(bytes, { strict = false, maximumBytes, maximumMemory, ...options } = {}) {
    const calls = library();
    return new Model(calls, calls.sunder_load_glb(bytesOf(bytes), fieldsOf(sunder_load_options, { isStrict: strict, maximumBytes, maximumMemory })), options);
  }
  static fromArrays(data, options = {}) {
    const calls = library();
    return new Model(calls, calls.sunder_create_character(characterData(data)), options);
  }

  get asset() { return this.handle && this.#asset; }
  get #data() { return this.#calls.sunder_get_character(this.handle); }

  get name() { return this.#calls.memory.text(this.#data.name); }
  get meshCount() { return this.#data.mesh_count; }
  /** { name, parent, rest }. */
  get bones() {
    const { bones, bone_count } = this.#data, { memory } = this.#calls;
    return memory.readStructs(sunder_bone, bones, bone_count).map(({ name, parent, rest }) => ({
      name: memory.text(name), parent: parent === 0xFFFFFFFF ? null : parent, rest }));
  }
  /** What vertices hang on: { name, bones, boneFromBind }; per slot a bone, and 12 numbers. As copies. */
  get skins() {
    const { skins, skin_count } = this.#data, { memory } = this.#calls;
    return memory.readStructs(sunder_skin, skins, skin_count).map(({ name, bones, bone_from_bind, slot_count }) => ({
      name: memory.text(name), bones: memory.viewOf(Uint32Array, bones, slot_count).slice(),
      boneFromBind: memory.viewOf(Float32Array, bone_from_bind, 12 * slot_count).slice() }));
  }
  /** { name, duration }. */
  get clips() {
    const { clips, clip_count } = this.#data, { memory } = this.#calls;
    return memory.readStructs(sunder_clip, clips, clip_count).map(({ name, duration }) => ({ name: memory.text(name), duration }));
  }
  /** How many weights a pose has for the morph targets of all meshes. */
  get morphWeightCount() { return this.#data.morph_weight_count; }
  /** What loading repaired, dropped or tells: { kind, place, text, count }. */
  get notes() {
    const { memory } = this.#calls;
    const { notes, count } = this.#calls.sunder_get_notes(this.handle);
    return memory.readStructs(sunder_note, notes, count).map((note) => ({
      kind: NOTES[note.kind], place: memory.text(note.place), text: memory.text(note.text), count: note.count }));
  }
  /** A mesh before any tear, in bind space. */
  mesh(index) {
    const { meshes, mesh_count } = this.#data, { memory } = this.#calls;
    if (!(index >= 0 && index < mesh_count)) throw invalidArgument(`mesh ${index} does not exist; the model has ${mesh_count}`);
    return new MeshData(memory, sunder_mesh.read(memory, meshes + index * sunder_mesh.size), () => this.handle);
  }
  bone(name) { return this.#calls.sunder_find_bone(this.handle, name); }
  clip(name) { return typeof name === 'number' ? name : this.#calls.sunder_find_clip(this.handle, name); }

  /** model_from_bone of each bone, 12 numbers each, with the transforms of a clip at a time; without a clip, those of rest. */
  matrices(clip = null, seconds = 0) {
    const calls = this.#calls, m = calls.memory, mark = m.mark(), count = this.#data.bone_count;
    try {
      const transforms = clip === null ? 0 : m.room(count * sunder_transform.size), to = m.room(96 * count);
      if (clip !== null) calls.sunder_sample_clip(this.handle, this.clip(clip), seconds, transforms, 0);
      calls.sunder_compute_matrices(this.handle, transforms, to);
      return m.viewOf(Float64Array, to, 12 * count).slice();
    } finally {
      m.release(mark);
    }
  }

  /** Rigid bodies and joints for a physics engine. @param matrices  the pose in which it stands */
  ragdoll(matrices = this.matrices(), options = {}) { return new Ragdoll(this.#calls, this.handle, matrices, options); }

  /**
   * A copy whose meshes have attributes of one number per vertex, in place of those of that name; files of it have them too.
   * @param attributes  { mesh, name: '_STRENGTH', values } each, one at least @param options  as those of load()
   */
  withAttributes(attributes, options = {}) {
    const calls = this.#calls;
    if (attributes.length === 0) throw invalidArgument('attributes are empty');
    let character = this.handle;
    for (const { mesh = 0, name, values } of attributes) {
      const before = character;
      try {
        character = calls.sunder_add_attribute(before, mesh, name, Float32Array.from(values), values.length);
      } finally {
        if (before !== this.handle) calls.sunder_destroy_character(before);
      }
    }
    return new Model(calls, character, options);
  }

  toGLB(options) { return takeBytes(this.#calls, this.#calls.sunder_save_glb(this.handle, fieldsOf(sunder_save_options, options))); }
}
