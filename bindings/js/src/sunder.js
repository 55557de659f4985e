// The front door: loads the library when it is first needed.
import { SUNDER_FEATURE_HULLS, SUNDER_FEATURE_THREADS, SUNDER_FEATURE_VALIDATION, sunder_cutting_resistance } from '../generated/calls.js';
import { initialise, library } from './library.js';
import { MATERIAL_NAMES, describeMaterial, materialOf } from './materials.js';
import { Model } from './model.js';
import { fieldsOf, triple } from './options.js';
import { Scene } from './scene.js';
import { takeReport, validationFields } from './validation.js';

export const Sunder = {
  /** Loads the library; load(), fromArrays() and createScene() do it too. @param source  bytes, module or response of sunder.wasm, or their promise */
  async init(source) { await initialise(source); },
  /** A model from a GLB, or from text glTF that refers to no other file. */
  async load(bytes, options) {
    await initialise();
    return Model.fromGLB(bytes, options);
  },
  /** A model from arrays. */
  async fromArrays(data, options) {
    await initialise();
    return Model.fromArrays(data, options);
  },
  async createScene(options) {
    await initialise();
    return new Scene(options);
  },
  get version() {
    const version = library().sunder_version();
    return [version >> 16, (version >> 8) & 255, version & 255].join('.');
  },
  get features() {
    const features = library().sunder_features();
    return { threads: (features & SUNDER_FEATURE_THREADS) !== 0, hulls: (features & SUNDER_FEATURE_HULLS) !== 0,
      validation: (features & SUNDER_FEATURE_VALIDATION) !== 0 };
  },
  /** Compares how the skins of two models deform. @param source  what is right @param target  what is measured */
  validate(source, target, options) {
    const calls = library();
    return takeReport(calls, calls.sunder_validate(source.handle, target.handle, validationFields(options)));
  },
  materialNames: MATERIAL_NAMES,
  /** The numbers of a material of tissue. */
  material(name) { return describeMaterial(library(), name); },
  /** The tension, N/m, under which a straight wound of a length opens by a gap in its middle. */
  tensionForGap(material, length, gap) {
    const calls = library();
    return calls.sunder_tension_for_gap(materialOf(calls, material), length, gap);
  },
  /** The force in newtons on a blade, three numbers against its motion. @param tissue  { toughness, thickness, friction, greatest } */
  bladeForce({ lengthTorn, depth, motion }, tissue = {}) {
    const calls = library(), m = calls.memory, mark = m.mark();
    try {
      const force = m.room(24);
      calls.sunder_blade_force(fieldsOf(sunder_cutting_resistance, tissue), lengthTorn, depth, triple(motion, 'motion'), force);
      return m.f64s(force, 3);
    } finally {
      m.release(mark);
    }
  },
  /** Bytes that the library has taken of memory. It never gives them back, but uses them again. */
  get memoryBytes() { return library().memory.buffer.byteLength; },
  /** The generated calls of the C library. */
  get calls() { return library(); },
};
