// Colours the character by the factors of a field while they are painted.
import * as THREE from 'three';
import { ColouredMesh } from './coloured_mesh.js';
import { factorsOf } from './paint.js';

/** A tenth, the tissue as it is, ten times: colours that people with colour vision deficiencies can tell apart. */
const LESS = new THREE.Color('#2166ac'), EVEN = new THREE.Color('#e8e4dc'), MORE = new THREE.Color('#b2182b');

const STOPS = [0.1, 0.22, 0.46, 0.8, 1, 1.25, 2.2, 4.6, 10];

function colourOf(factor) {
  const place = Math.max(-1, Math.min(1, Math.log10(Math.max(factor, 1e-9))));
  return EVEN.clone().lerp(place < 0 ? LESS : MORE, Math.abs(place) ** 0.6);  // small differences are seen too
}
function coloursOf(factors) {
  const colours = new Float32Array(3 * factors.length), known = new Map();
  factors.forEach((factor, v) => {
    if (!known.has(factor)) known.set(factor, colourOf(factor));
    known.get(factor).toArray(colours, 3 * v);
  });
  return colours;
}

export class PaintedColours {
  #legend;
  #meshes = [];
  #material = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.9, side: THREE.DoubleSide });
  #known = '';

  /** @param legend  an element that gets the colours and the factors that they mean */
  constructor(legend) { this.#legend = legend; }
  get isShown() { return this.#known !== ''; }

  /** @param field  that is shown; null: none @param stroke  a PaintStroke that is being drawn, or null */
  update({ instance, object, model }, field, stroke) {
    const wanted = field ? `${field} ${instance.id} ${model.asset} ${instance.digest}` : '';
    if (wanted !== this.#known) {
      this.clear();
      this.#known = wanted;
      if (field) this.#show(instance, object, model, field);
    }
    this.#meshes.forEach((mesh, i) => {
      mesh.follow();
      const painted = stroke?.values(i);
      if (painted) mesh.colour(coloursOf(painted));
    });
  }
  clear() {
    for (const mesh of this.#meshes) mesh.dispose();
    if (this.isShown) this.#legend.hidden = true;
    this.#meshes = [];
    this.#known = '';
  }

  #show(instance, object, model, field) {
    this.#meshes = object.children.slice(0, model.meshCount).map((mesh, i) =>
      new ColouredMesh(mesh, this.#material, coloursOf(factorsOf(instance, i, field)), EVEN));
    const [least, ramp, most, note] = this.#legend.children;
    least.textContent = '× 0.1';
    ramp.style.background = `linear-gradient(to right, ${STOPS.map((factor) => `#${colourOf(factor).getHexString()}`).join()})`;
    most.textContent = '× 10';
    note.textContent = `The factor of the tissue's ${field}; the middle is 1.`;
    this.#legend.hidden = false;
  }
}
