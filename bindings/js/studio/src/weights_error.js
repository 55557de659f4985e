// Colours the character by how far each vertex strays from where the model before any tear would have it.
import * as THREE from 'three';
import { niceTop, quantity } from '../../../../tools/page_parts/src/format.js';
import { ColouredMesh } from './coloured_mesh.js';

/** From nothing to the top of the scale: viridis, which people with colour vision deficiencies can read. */
const RAMP = ['#440154', '#472d7b', '#3b528b', '#2c728e', '#21918c', '#28ae80', '#5ec962', '#addc30', '#fde725'].map((colour) => new THREE.Color(colour));
/** Of vertices without a place on the model: the insides of wounds. */
const UNKNOWN = new THREE.Color('#8d8d8d');

function colourOf(value, top) {
  if (Number.isNaN(value)) return UNKNOWN;
  const place = Math.min(value / top, 1) * (RAMP.length - 1), first = Math.min(Math.floor(place), RAMP.length - 2);
  return RAMP[first].clone().lerp(RAMP[first + 1], place - first);
}

export class WeightsError {
  #legend;
  #meshes = [];
  #material = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.9, side: THREE.DoubleSide });
  #known = '';
  isShown = false;
  /** What was measured last: { deviations, newest … }; null: nothing is shown. */
  report = null;

  /** @param legend  an element that gets the colours and the lengths that they mean */
  constructor(legend) { this.#legend = legend; }

  /** Measures again after an operation. @param isBusy  whether a tool works: then the colours wait */
  update(actor, isBusy) {
    const { instance } = actor, wanted = this.isShown ? `${instance.id} ${instance.digest} ${actor.model.asset}` : '';
    if (wanted !== this.#known && !(isBusy && this.isShown)) {
      this.clear();
      this.#known = wanted;
      if (this.isShown) this.#measure(actor);
    }
    for (const mesh of this.#meshes) mesh.follow();
  }
  /** Of a character that goes. */
  clear() {
    for (const mesh of this.#meshes) mesh.dispose();
    this.#meshes = [];
    this.#known = '';
    this.report = null;
    this.#legend.hidden = true;
  }

  #measure({ instance, object, model }) {
    const report = instance.validate(), { deviations, sampled } = report, top = niceTop(sampled);
    let first = 0;
    for (const [i, mesh] of object.children.slice(0, model.meshCount).entries()) {
      const count = instance.mesh(i).vertexCount, colours = new Float32Array(3 * count);
      for (let v = 0; v < count; ++v) colourOf(deviations[first + v], top).toArray(colours, 3 * v);
      first += count;
      this.#meshes.push(new ColouredMesh(mesh, this.#material, colours, UNKNOWN));
    }
    this.report = report;
    const [least, ramp, most, note] = this.#legend.children;
    least.textContent = '0 m';
    ramp.style.background = `linear-gradient(to right, ${RAMP.map((colour) => `#${colour.getHexString()}`).join()})`;
    most.textContent = sampled > 0 ? quantity(top, 'm') : 'equal';
    note.textContent = `Largest distance from the model before any tear in ${report.poseCount} poses; at most ${quantity(sampled, 'm')}. Grey: inside a wound.`;
    this.#legend.hidden = false;
  }

  /** Pairs of a name and its text, as those of the read-out. */
  get lines() {
    if (!this.report) return [];
    const { newest, sampled, vertexCount, unmatched } = this.report;
    const bound = ({ certified, uncertified }, count) =>
      (uncertified === count ? 'none' : `≤ ${quantity(certified, 'm')}${uncertified > 0 ? `, ${uncertified} without` : ''}`);
    return [
      ['Weights’ error, tried poses', quantity(sampled, 'm')],
      ['Its bound in all poses', bound(this.report, vertexCount - unmatched)],
      ['Bound of the last operation', newest.points > 0 ? bound(newest, newest.points) : 'no new points'],
    ];
  }
}
