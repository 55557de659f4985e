// One character in a scene.
import { SUNDER_IN_BACKGROUND, sunder_blood_flow_options, sunder_bore, sunder_collider, sunder_contact, sunder_cut, sunder_detach, sunder_force_tearing_options, sunder_layer_options, sunder_save_options, sunder_stroke_sampling, sunder_suture, sunder_suture_thread, sunder_tear_options, sunder_weld, sunder_wound_mask_options } from '../generated/calls.js';
import { Hold, Layer, Stroke } from './handles_of_tissue.js';
import { takeBytes, takeText } from './made_bytes.js';
import { materialOf } from './materials.js';
import { MeshData } from './mesh_data.js';
import { blade, blades, bytesOf, fieldsOf, namesOf, quadruple, triple } from './options.js';
import { PosedMesh } from './posed_mesh.js';
import { invalidArgument, invalidHandle } from './sunder_error.js';
import { takeReport, validationFields } from './validation.js';

const NONE = 0xFFFFFFFF;
const CHANNELS = ['age', 'depth', 'stretch'];
const contactOf = ({ has_hit, contact }) => (has_hit ? namesOf(contact) : null);
const flagsOf = (background) => (background ? SUNDER_IN_BACKGROUND : 0);

/** The numbers of points, one after the other. */
const flat = (points, what) => {
  if (points.length === 0) throw invalidArgument(`${what} are empty; without them there is no such limit`);
  return Float64Array.from(points.flatMap((point) => [...triple(point, what)]));
};

export class Instance {
  #scene;
  #id;
  #model;
  #calls;

  constructor(scene, id, model) {
    this.#scene = scene;
    this.#id = id;
    this.#model = model;
    this.#calls = scene.calls;
  }

  get id() { return this.#id; }
  get model() { return this.#model; }
  get scene() { return this.#scene; }
  get exists() { return !this.#scene.isDisposed && this.#call('sunder_has_instance') !== 0; }

  #call(name, ...values) { return this.#calls[name](this.#scene.handle, this.#id, ...values); }
  /** For calls that change what views show. */
  #change(name, ...values) {
    try {
      return this.#call(name, ...values);
    } finally {
      this.#scene.changed();
    }
  }
  #submit(name, ...values) { return this.#scene.expect(this.#call(name, ...values)); }

  // ---- operations: applied by the next update of the scene, in the pose of then ----

  /** Tears along a stroke. @param stroke  positions of the blade, each a base outside and a tip inside */
  tear(stroke, { background = false, ...options } = {}) {
    return this.#submit('sunder_submit_tear', blades(stroke), fieldsOf(sunder_tear_options, options), flagsOf(background));
  }
  /** Begins a tear that goes on for some frames. */
  beginStroke(position, { minimumDistance, minimumSeconds, ...options } = {}) {
    const begun = this.#submit('sunder_submit_begin_stroke', blade(position), fieldsOf(sunder_tear_options, options),
      fieldsOf(sunder_stroke_sampling, { minimumDistance, minimumSeconds }));
    return new Stroke((name, ...values) => this.#submit(name, ...values), begun);
  }
  /** Cuts by a plane. @param plane  { point, normal }; `polygon`: corners that bound it; `sections`: only those nearest to places */
  cut({ polygon, sections, bone, background = false, firstHit, ...options }) {
    const fields = fieldsOf(sunder_cut, options);
    if (polygon) Object.assign(fields, { bounds: flat(polygon, 'polygon'), bound_count: polygon.length });
    if (sections) Object.assign(fields, { sections: flat(sections, 'sections'), section_count: sections.length });
    if (bone) fields.bone = bone;
    if (firstHit) {
      Object.assign(fields, { has_first_hit: 1, ray_origin: triple(firstHit.origin, 'origin'), ray_direction: triple(firstHit.direction, 'direction') });
    }
    return this.#submit('sunder_submit_cut', fields, flagsOf(background));
  }
  /** Bores a round hole. @param bore  { origin, direction, radius, depth } */
  drill({ background = false, ...options }) { return this.#submit('sunder_submit_drill', fieldsOf(sunder_bore, options), flagsOf(background)); }
  /** Closes wounds whose lips lie on one another. @param options  { places, reach }: only the wounds nearest to places, so far along them */
  weld({ places, background = false, ...options } = {}) {
    const fields = fieldsOf(sunder_weld, options);
    if (places) Object.assign(fields, { places: flat(places, 'places'), place_count: places.length });
    return this.#submit('sunder_submit_weld', fields, flagsOf(background));
  }
  /** Ties threads between lips that lie on one another. @param options  { places, reach, spacing, stiffness, tension, strength } */
  suture({ places, background = false, ...options } = {}) {
    const fields = fieldsOf(sunder_suture, options);
    if (places) Object.assign(fields, { places: flat(places, 'places'), place_count: places.length });
    return this.#submit('sunder_submit_suture', fields, flagsOf(background));
  }
  /** Takes a connected piece off. @param piece  { mesh, triangle } or { point, bone }; its Result has the piece */
  detach({ bone, ...options }) {
    const fields = fieldsOf(sunder_detach, options);
    if (bone) fields.bone = bone;
    return this.#submit('sunder_submit_detach', fields);
  }
  undo() { return this.#submit('sunder_submit_undo'); }
  redo() { return this.#submit('sunder_submit_redo'); }
  /** { undo, redo }: how often each can be done. */
  get undoCounts() { return this.#call('sunder_get_undo_counts'); }
  /** Takes now the memory that the first operation would take. */
  prepareToTear() { this.#change('sunder_prepare_to_tear'); }

  // ---- logs and files ----

  /** The operations that are done, as text that makes the same model again, bit for bit. */
  get log() { return takeText(this.#calls, this.#call('sunder_get_log')); }
  /** Applies a log at once. @returns the number of operations; an error has the number of the one that failed as its index */
  applyLog(json) { return this.#change('sunder_apply_log', bytesOf(json)); }
  /** A hash of all bits of the torn model, equal on every machine; 0n: nothing was torn yet. */
  get digest() { return this.#call('sunder_get_digest'); }
  /** The torn character as a file. */
  toGLB(options) { return takeBytes(this.#calls, this.#call('sunder_save_instance', fieldsOf(sunder_save_options, options))); }

  /** How the torn skin deforms beside that of the model, and what the newest operation did to it. */
  validate(options) { return takeReport(this.#calls, this.#call('sunder_validate_instance', validationFields(options))); }

  // ---- the pose ----

  #layer(name, clip, options) {
    const layer = this.#call(name, this.#model.clip(clip), fieldsOf(sunder_layer_options, options));
    return new Layer((call, ...values) => this.#call(call, ...values), layer);
  }
  /** Plays a clip, by its number or name. */
  play(clip = 0, options = {}) { return this.#layer('sunder_play', clip, options); }
  crossFade(clip, options = {}) { return this.#layer('sunder_cross_fade', clip, options); }
  stop() { this.#call('sunder_stop'); }
  /** Refuses what the library would read past the end of. */
  #checkedMorphWeights(weights) {
    const count = this.#model.morphWeightCount;
    if (weights !== null && weights.length !== count) throw invalidArgument(`${weights.length} morph weights; the model has ${count}`);
    return weights;
  }
  /** The pose of the next update: 12 numbers per bone, model_from_bone, column after column. */
  setMatrices(matrices, morphWeights = null) {
    this.#call('sunder_set_matrices', matrices, matrices.length / 12, this.#checkedMorphWeights(morphWeights));
  }
  /** The pose of the next update: { translation, rotation, scale } per bone, each relative to its parent. */
  setTransforms(transforms, morphWeights = null) {
    this.#call('sunder_set_transforms', transforms, transforms.length, this.#checkedMorphWeights(morphWeights));
  }
  /** The pose of the last update, 12 numbers per bone: a view until the next one. */
  get matrices() {
    const { model_from_bone, bone_count } = this.#call('sunder_get_pose');
    return this.#calls.memory.viewOf(Float64Array, model_from_bone, 12 * bone_count);
  }

  // ---- drawing ----

  /** @param seen  `epoch` of the state that the caller's buffers have; 0n: they have none */
  mesh(index = 0, seen = 0n) {
    return new PosedMesh(this.#calls.memory, this.#call('sunder_get_posed_mesh', index, seen), this.#validity());
  }
  /** The torn mesh in bind space, with all attributes. */
  source(index = 0) {
    const { memory } = this.#calls, mesh = this.#call('sunder_get_instance_mesh', index);
    return new MeshData(memory, mesh, this.#validity());
  }
  /** Keeps the wounds of a mesh in its texture from now on. @param options  width, height, uvSet, dilation, reach; firstOperation, operationCount: only their wounds */
  beginWoundMask(options = {}, index = 0) { this.#change('sunder_begin_wound_mask', index, fieldsOf(sunder_wound_mask_options, options)); }
  endWoundMask(index = 0) { this.#change('sunder_end_wound_mask', index); }
  /** Distances to the nearest lip along the surface, row by row from the top, and the rectangle that changed since the last call. */
  woundMask(index = 0) {
    const { left, top, changed_width, changed_height, distances, ...mask } = this.#call('sunder_get_wound_mask', index);
    return {
      ...namesOf(mask), changed: { left, top, width: changed_width, height: changed_height },
      distances: this.#calls.memory.viewOf(Float32Array, distances, mask.width * mask.height) };
  }
  /** Per texel of the mask. 'age': operations since the one that made the nearest lip, -1: none in reach; 'depth': of the wall below
   * that lip; 'stretch': of the skin that was drawn, 1 beyond reach. A view until the next channel or flowBlood() of the scene. */
  woundChannel(channel, index = 0) {
    if (!CHANNELS.includes(channel)) throw invalidArgument(`'${channel}' is no channel; there are ${CHANNELS.join(', ')}`);
    return this.#texelsOf(this.#call('sunder_get_wound_channel', index, CHANNELS.indexOf(channel)));
  }
  /** Lets blood run down from the lips: how much is on each texel of the mask, 0 to 1. @param options  down, length, width, spacing, seed */
  flowBlood(options = {}, index = 0) {
    return this.#texelsOf(this.#call('sunder_flow_blood', index, fieldsOf(sunder_blood_flow_options, options)));
  }
  #texelsOf({ texels, texel_count }) { return this.#calls.memory.viewOf(Float32Array, texels, texel_count); }
  #validity() {
    const scene = this.#scene, version = scene.version;
    return () => {
      if (scene.isDisposed || scene.version !== version) throw invalidHandle('this mesh is of an earlier update: ask the instance for it again');
    };
  }
  set visible(visible) { this.#call('sunder_set_visible', visible ? 1 : 0); }
  /** Far instances are updated less often. */
  set screenHeight(pixels) { this.#call('sunder_set_screen_height', pixels); }

  // ---- tissue ----

  /** { particleCount, pointCount, isAwake }. */
  get tissue() { return namesOf(this.#call('sunder_get_tissue')); }
  /** The threads of all sutures as they were tied: { left, right, newtons, isBroken }; an end is { mesh, vertex }, or null if it holds nothing any more. */
  get threads() {
    const { threads, count } = this.#call('sunder_get_threads');
    const end = (mesh, vertex) => (mesh === NONE ? null : { mesh, vertex });
    return this.#calls.memory.readStructs(sunder_suture_thread, threads, count).map((raw) => ({
      left: end(raw.left_mesh, raw.left_vertex), right: end(raw.right_mesh, raw.right_vertex), newtons: raw.newtons, isBroken: raw.is_broken !== 0 }));
  }
  /** Pulls tissue to a place. @param at  { mesh, vertex }, or a contact of raycast() */
  hold(at, target, { stiffness = 0 } = {}) {
    const point = this.#point(at);
    return new Hold((name, ...values) => this.#call(name, ...values), this.#call('sunder_hold_point', point, triple(target, 'target'), stiffness));
  }
  push(at, newtonSeconds) { this.#call('sunder_add_impulse', this.#point(at), triple(newtonSeconds, 'newtonSeconds')); }
  #point({ mesh = 0, vertex, triangle, barycentric }) {
    let nearest = vertex;
    if (nearest === undefined && triangle !== undefined) {
      const corner = barycentric ? barycentric.indexOf(Math.max(...barycentric)) : 0;
      nearest = this.source(mesh).triangles[3 * triangle + corner];
    }
    const point = nearest === undefined ? 0xFFFFFFFF : this.#call('sunder_get_point', mesh, nearest);
    if (point === 0xFFFFFFFF) throw invalidArgument('no point of tissue is there: { mesh, vertex }, or a contact of raycast() is expected');
    return point;
  }
  set gravity(gravity) { this.#call('sunder_set_gravity', triple(gravity, 'gravity')); }
  setTension(newtonsPerMetre, { addsPoseStrain = false } = {}) { this.#call('sunder_set_tension', newtonsPerMetre, addsPoseStrain ? 1 : 0); }
  setMaterial(material, index = 0) { this.#call('sunder_change_material', index, materialOf(this.#calls, material)); }
  /** Tears at once, at one place at most, where tissue gives way; after an update. The next one draws it. */
  tearOverstretched(options = {}) {
    return namesOf(this.#change('sunder_tear_overstretched', fieldsOf(sunder_force_tearing_options, options)));
  }
  /** Replaces all colliders. @param colliders  { shape, size, place, rotation, friction } each */
  setColliders(colliders) {
    this.#call('sunder_set_colliders', colliders.map(({ rotation = [0, 0, 0, 1], size = [0, 0, 0], ...others }) => ({
      size, friction: 0, ...fieldsOf(sunder_collider, { place: [0, 0, 0], ...others }), rotation: quadruple(rotation, 'rotation') })));
  }
  moveCollider(collider, place, rotation = [0, 0, 0, 1]) {
    this.#call('sunder_move_collider', collider, triple(place, 'place'), quadruple(rotation, 'rotation'));
  }
  /** Lets the soft instance of a piece, not updated yet, move on as the piece did. */
  inheritMotion(piece) { this.#call('sunder_inherit_motion', piece.handle); }

  // ---- contact with the drawn surface ----

  /** Where a ray meets the surface first, or null. Needs prepareToTear() or an operation before, and an update. */
  raycast(origin, direction, length = 1e9) {
    return contactOf(this.#call('sunder_cast_ray', triple(origin, 'origin'), triple(direction, 'direction'), length));
  }
  nearest(point, mostDistance = 1e9) { return contactOf(this.#call('sunder_find_nearest', triple(point, 'point'), mostDistance)); }
  /** All places where a blade crosses the surface, from base to tip; at most 64. */
  bladeContacts(position) {
    const m = this.#calls.memory, mark = m.mark(), most = 64;
    try {
      const to = m.room(most * sunder_contact.size);
      const count = this.#call('sunder_find_blade_contacts', blade(position), to, most);
      return m.readStructs(sunder_contact, to, Math.min(count, most)).map((contact) => namesOf(contact));
    } finally {
      m.release(mark);
    }
  }

  /** Takes it out of the scene. */
  dispose() {
    if (this.exists) this.#change('sunder_destroy_instance');
    this.#scene.forget(this.#id);
  }
}
