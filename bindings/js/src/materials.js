// Materials of tissue by name, or changed from one.
import { sunder_material } from '../generated/calls.js';
import { fieldsOf, namesOf } from './options.js';

export const MATERIAL_NAMES = ['skin', 'fat', 'muscle', 'liver', 'rubber', 'foam', 'cloth', 'jelly'];

/** The fields of 'skin', or of { base: 'skin', strength: 1.4 }. */
export function materialOf(calls, material) {
  if (typeof material === 'string') return calls.sunder_find_material(material);
  const { base = null, ...changes } = material;
  return { ...(base ? calls.sunder_find_material(base) : calls.sunder_default_material()), ...fieldsOf(sunder_material, changes) };
}
export const describeMaterial = (calls, name) => namesOf(materialOf(calls, name));
