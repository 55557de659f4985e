// The character on the stage: its model, its tissue, and how it is drawn.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { Sunder } from 'sunder-tear';
import { SunderObject } from '../../src/three/index.js';
import { Blood } from './blood.js';
import { Brush } from './brush.js';
import { Inside } from './inside.js';
import { PaintStroke, attributesOf, fieldsIn } from './paint.js';
import { Stitches } from './stitches.js';

/** Wounds of this share of the size are meant, when tension is chosen. */
const WOUND = 0.25;

/** What three makes of a file, whose materials are used; null if it cannot decode it: then the model is drawn plain. */
async function parsed(bytes) {
  try {
    return await new GLTFLoader().parseAsync(bytes.slice().buffer, '');
  } catch {
    return null;
  }
}

/** A model whose tissue has the fields that its file has as attributes: { model, fields }. */
async function loaded(bytes, material) {
  const model = await Sunder.load(bytes, { soft: material }), fields = fieldsIn(model);
  if (fields.length === 0) return { model, fields };
  model.dispose();
  return { model: await Sunder.load(bytes, { soft: material, fields }), fields };
}

/** `tissue` is the scene of the character alone, so that its snapshots are; `parts` that of what came off. */
export class Actor {
  #layer = null;
  #material = 'skin';
  /** The model of the file, and what the file painted. */
  #unpainted = null;
  #fieldsOfFile = [];
  #brush = new Brush();
  /** What is painted on the tissue: { mesh, field, values } each. */
  fields = [];
  isTearing = false;

  static async create(bytes, material) {
    const { model, fields } = await loaded(bytes, material);
    const actor = new Actor();
    actor.#material = material;
    actor.model = actor.#unpainted = model;
    actor.fields = actor.#fieldsOfFile = fields;
    actor.tissue = await Sunder.createScene();
    actor.parts = await Sunder.createScene();
    actor.instance = actor.tissue.spawn(model);
    actor.instance.prepareToTear();
    if (model.clips.length) actor.play(0);
    actor.tissue.update(0);
    actor.gltf = await parsed(bytes);
    actor.object = new SunderObject(actor.instance, { gltf: actor.gltf });
    actor.object.update();
    actor.inside = new Inside(actor.object.children.flatMap(({ material }) => material));
    for (const mesh of actor.object.children) mesh.castShadow = mesh.receiveShadow = true;
    actor.size = actor.box.getSize(new THREE.Vector3()).length() || 1;
    actor.blood = new Blood(actor.instance, actor.object, actor.size);
    actor.stitches = new Stitches(actor.instance, actor.object, actor.size);
    return actor;
  }

  /** In its own space. */
  get box() { return this.object.children.reduce((box, { geometry }) => box.union(geometry.boundingBox), new THREE.Box3()); }

  play(clip) {
    this.instance.stop();
    this.clip = clip;
    this.#layer = this.instance.play(clip);
  }
  /** Seconds; 0 without a clip. */
  get time() { return this.#layer ? this.#layer.state.time : 0; }
  set time(seconds) { this.#layer?.seek(seconds); }
  set isPlaying(plays) { if (this.#layer) this.#layer.speed = plays ? 1 : 0; }
  get duration() { return this.model.clips[this.clip]?.duration ?? 0; }

  /** Lips of a wound of a quarter of the size open by a share of its length. */
  setTension(share) {
    this.instance.setTension(share > 0 ? Sunder.tensionForGap(this.#material, WOUND * this.size, share * WOUND * this.size) : 0);
  }

  setTissue(material) {
    this.#material = material;
    this.instance.setMaterial(material);
  }

  /** @param settings  { field, factor, radius }: the radius as a share of the size */
  beginPaint({ field, factor, radius }) { return new PaintStroke(this, this.#brush, { field, factor, radius: radius * this.size }); }
  /**
   * Gives the tissue other fields. What instances share cannot change, so another instance takes the place of this one, and the
   * operations are done again, also those that were undone; they make the same bits. Nothing changes if that fails.
   */
  async repaint(fields) {
    const model = fields === this.#fieldsOfFile ? this.#unpainted
      : this.#unpainted.withAttributes(attributesOf(fields), { soft: this.#material, fields });
    const tissue = await Sunder.createScene();
    try {
      this.#show(model, tissue);
    } catch (error) {
      tissue.dispose();
      if (model !== this.#unpainted) model.dispose();
      throw error;
    }
    this.fields = fields;
  }
  #show(model, tissue) {
    const instance = tissue.spawn(model), { undo, redo } = this.instance.undoCounts, { time, clip } = this, speed = this.#layer?.state.speed;
    const repeat = (count, which, of, scene) => {
      for (let i = 0; i < count; ++i) of[which]();
      if (count > 0) scene.update(0);
    };
    instance.prepareToTear();
    tissue.update(0);
    repeat(redo, 'redo', this.instance, this.tissue);
    if (undo + redo > 0) instance.applyLog(this.instance.log);
    tissue.update(0);
    repeat(redo, 'undo', instance, tissue);
    const before = { tissue: this.tissue, model: this.model };
    Object.assign(this, { model, tissue, instance });
    if (clip !== undefined) {
      this.play(clip);
      this.time = time;
      this.#layer.speed = speed ?? 1;
    }
    tissue.update(0);
    this.object.instance = this.stitches.instance = instance;
    this.blood.restart(instance);
    before.tissue.dispose();
    if (before.model !== this.#unpainted && before.model !== model) before.model.dispose();
  }

  /** Where a ray meets the surface: a contact of the library with the ray in the model's space, or null. */
  hit(ray) {
    const { origin, direction } = this.object.localRay(ray), contact = this.instance.raycast(origin, direction);
    return contact && { ...contact, origin, direction, at: new THREE.Vector3(...contact.place) };
  }
  /** A tear that goes on for some frames. There is one at a time. @param depth, width  as shares of the size */
  beginTear(position, { depth, width }) {
    const stroke = this.instance.beginStroke(position, { width: width * this.size, wallDepth: 0.75 * depth * this.size, weights: 'poseExact' });
    this.isTearing = true;
    return {
      extend: (next, seconds) => stroke.extend(next, seconds),
      end: () => {
        this.isTearing = false;
        return stroke.end();
      },
    };
  }

  dispose() {
    this.stitches.dispose();
    this.object.removeFromParent();
    this.object.dispose();
    this.blood.dispose();
    this.tissue.dispose();
    this.parts.dispose();
    if (this.model !== this.#unpainted) this.model.dispose();
    this.#unpainted.dispose();
  }
}
