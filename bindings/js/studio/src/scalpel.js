// A blade in a hand that holds a controller: the trigger presses it into tissue, the grip pulls tissue.
import * as THREE from 'three';
import { Sunder } from 'sunder-tear';

const LENGTH = 0.14;    // metres, of the hand's room
const REACH = 0.05;     // from the tip to tissue that the grip takes
const RESISTANCE = { toughness: 2000, thickness: 0.004, friction: 20, greatest: 10 };  // J/m^2, m, N/m, N: as skin resists
const LEAST_FELT = 0.02;  // newtons
const PULSE = 25;         // milliseconds: until the next frame at the slowest rate
const [UNDO, REDO] = [4, 5];  // buttons of the standard mapping: A or X, B or Y

function drawn() {
  const steel = new THREE.MeshStandardMaterial({ color: 0xc8ccd4, metalness: 0.6, roughness: 0.3 });
  const handle = new THREE.Mesh(new THREE.CylinderGeometry(0.006, 0.008, 0.1, 12), steel), edge = new THREE.Mesh(new THREE.ConeGeometry(0.006, LENGTH, 4), steel);
  handle.rotation.x = edge.rotation.x = -Math.PI / 2;
  handle.position.z = 0.05;
  edge.position.z = -LENGTH / 2;
  edge.scale.x = 0.3;
  return new THREE.Group().add(handle, edge);
}

export class Scalpel {
  #actor = null;
  #source = null;
  #isPressed = false;
  #grips = false;
  #buttons = [];
  #stroke = null;
  #command = null;
  #pull = null;
  #tip = null;
  #motion = new THREE.Vector3();
  #depth = 0;

  /** @param controller  of WebXRManager.getController() @param studio  whose operations its buttons undo */
  constructor(controller, studio) {
    this.controller = controller;
    this.studio = studio;
    this.drawn = drawn();
    controller.add(this.drawn);
    this.#listen('connected', ({ data }) => { this.#source = data; });
    this.#listen('disconnected', () => { this.#source = null; });
    this.#listen('selectstart', () => { this.#isPressed = true; });
    this.#listen('selectend', () => { this.#isPressed = false; });
    this.#listen('squeezestart', () => { this.#grips = true; });
    this.#listen('squeezeend', () => { this.#grips = false; });
  }
  #listeners = [];
  #listen(type, act) {
    this.controller.addEventListener(type, act);
    this.#listeners.push([type, act]);
  }

  /** Before an update: what the hand does at the place where it is now. */
  act({ actor, settings, seconds }) {
    if (actor !== this.#actor) this.#meet(actor);
    this.#pressButtons();
    const isTracked = this.#source !== null && this.controller.visible, position = isTracked ? this.#bladeIn(actor) : null;
    if (position) this.#motion.copy(position.tip).sub(this.#tip ?? position.tip);
    this.#tip = position?.tip ?? null;
    const [entry] = position ? actor.instance.bladeContacts(position) : [];
    this.#depth = entry?.enters ? Math.max(entry.depth, 0) : 0;
    this.#tear(position, settings, seconds);
    this.#pullAlong(position);
  }

  /** After an update: what the hand feels of it. */
  feel({ actor, settings }) {
    if (this.#pull && settings.givesWay && !actor.isTearing) actor.instance.tearOverstretched({ metres: 0.01 * actor.size });
    const scale = this.#scale(), lengthTorn = scale * (this.#command?.result?.length ?? 0);
    this.#command = null;
    if (this.#depth === 0) return;
    const force = Sunder.bladeForce({ lengthTorn, depth: scale * this.#depth, motion: this.#motion.clone().multiplyScalar(scale) }, RESISTANCE);
    const newtons = Math.hypot(...force);
    if (newtons > LEAST_FELT) this.#source?.gamepad?.hapticActuators?.[0]?.pulse(newtons / RESISTANCE.greatest, PULSE);
  }

  /** Another character: what was done to the last one is over. */
  #meet(actor) {
    this.#stroke = this.#command = this.#pull = this.#tip = null;
    this.#actor = actor;
  }
  /** Metres of the room in one of the character. */
  #scale() { return this.#actor.object.getWorldScale(new THREE.Vector3()).x; }
  #bladeIn({ object }) {
    this.controller.updateWorldMatrix(true, false);
    const placed = (z) => object.worldToLocal(new THREE.Vector3(0, 0, z).applyMatrix4(this.controller.matrixWorld));
    return { base: placed(0), tip: placed(-LENGTH) };
  }

  #tear(position, settings, seconds) {
    if (this.#isPressed && this.#depth > 0) {
      if (this.#stroke) this.#command = this.#stroke.extend(position, seconds);
      else if (!this.#actor.isTearing) this.#stroke = this.#actor.beginTear(position, settings);
    } else if (this.#stroke) {
      this.#stroke.end();
      this.#stroke = null;
    }
  }

  #pullAlong(position) {
    const { instance } = this.#actor;
    if (this.#grips && position) {
      const { tip } = position;
      if (this.#pull) this.#pull.hold.move(this.#pull.from.clone().add(tip).sub(this.#pull.tip));
      else {
        const contact = instance.nearest(tip, REACH / this.#scale());
        if (contact) this.#pull = { hold: instance.hold(contact, contact.place), from: new THREE.Vector3(...contact.place), tip };
      }
    } else if (this.#pull) {
      this.#pull.hold.release();
      this.#pull = null;
    }
  }

  #pressButtons() {
    const pressed = (this.#source?.gamepad?.buttons ?? []).map((button) => button.pressed), goesDown = (i) => pressed[i] && !this.#buttons[i];
    if (goesDown(UNDO)) this.studio.undo();
    if (goesDown(REDO)) this.studio.redo();
    this.#buttons = pressed;
  }

  /** Lays it down. */
  dispose() {
    this.#stroke?.end();
    this.#pull?.hold.release();
    for (const [type, act] of this.#listeners) this.controller.removeEventListener(type, act);
    this.controller.removeFromParent();
    this.drawn.removeFromParent();
    for (const { geometry, material } of this.drawn.children) {
      geometry.dispose();
      material.dispose();
    }
  }
}
