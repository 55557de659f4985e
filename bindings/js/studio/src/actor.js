// The character on the stage: its model, its tissue, and how it is drawn.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { Sunder } from 'sunder-tear';
import { SunderObject } from '../../src/three/index.js';
import { Blood } from './blood.js';
import { Inside } from './inside.js';
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

/** `tissue` is the scene of the character alone, so that its snapshots are; `parts` that of what came off. */
export class Actor {
  #layer = null;
  #material = 'skin';
  isTearing = false;

  static async create(bytes, material) {
    const model = await Sunder.load(bytes, { soft: material });
    const actor = new Actor();
    actor.#material = material;
    actor.model = model;
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
    this.model.dispose();
  }
}
