// Options as JavaScript writes them, { wallDepth: 0.02 }, become the fields of a struct of the library, { wall_depth: 0.02 }.
import * as api from '../generated/calls.js';
import { invalidArgument } from './sunder_error.js';

/** Names of values: 'all' for SUNDER_LAYERS_ALL. By field. */
const chosen = (prefix, names) => Object.fromEntries(names.map((name) => [name, api[`SUNDER_${prefix}_${name.replace(/([A-Z])/g, '_$1').toUpperCase()}`]]));
const WEIGHTS = chosen('WEIGHTS', ['barycentric', 'poseExact', 'refit', 'exact', 'ofModel']);
const CHOICES = {
  layers: chosen('LAYERS', ['nearest', 'all']),
  weight_policy: WEIGHTS,
  skinning: chosen('SKIN', ['linear', 'dualQuaternion']),
  motion: chosen('PIECE', ['frozen', 'animated', 'vanishes']),
  axes: chosen('AXES', ['principal', 'model']),
  open_surfaces: chosen('SOLID', ['closed', 'fans', 'shell']),
  kind: chosen('LAYER', ['whole', 'animated', 'additive']),
  mode: chosen('PLAY', ['loop', 'pingPong', 'once']),
  easing: chosen('EASE', ['linear', 'smooth', 'in', 'out']),
  field: chosen('FIELD', ['strength', 'toughness', 'stiffness', 'tension', 'thickness']),
  shape: chosen('COLLIDER', ['sphere', 'capsule', 'box', 'halfSpace']),
};
/** Words that read better than the fields. */
const OTHER_NAMES = { weights: 'weight_policy', caps: 'has_caps', wall: 'has_wall', wallDepth: 'wall_depth', soft: 'is_soft', visible: 'is_visible', clipLimits: 'has_clip_limits' };

const snake = (name) => OTHER_NAMES[name] ?? name.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`);
const camel = (name) => name.replace(/_([a-z])/g, (_, letter) => letter.toUpperCase());

/** Three numbers from an array or from an object with x, y, z. */
export function triple(value, what) {
  const numbers = value?.x === undefined ? value : [value.x, value.y, value.z];
  if (!(numbers?.length === 3)) throw invalidArgument(`${what}: three numbers, or x, y and z, are expected`);
  return numbers;
}
export function quadruple(value, what) {
  const numbers = value?.x === undefined ? value : [value.x, value.y, value.z, value.w];
  if (!(numbers?.length === 4)) throw invalidArgument(`${what}: four numbers, or x, y, z and w, are expected`);
  return numbers;
}

/** How many numbers a field has, where it is a vector. */
const VECTORS = new Set(['point', 'normal', 'origin', 'direction', 'gravity', 'ray_origin', 'ray_direction', 'size', 'place', 'down']);

function valueOf(field, value) {
  if (CHOICES[field] && typeof value === 'string') {
    if (CHOICES[field][value] === undefined)
      throw invalidArgument(`${camel(field)}: '${value}' is none of ${Object.keys(CHOICES[field]).join(', ')}`);
    return CHOICES[field][value];
  }
  if (VECTORS.has(field)) return triple(value, camel(field));
  return typeof value === 'boolean' ? Number(value) : value;
}

/** The fields of a struct; an option that it does not have is an error, because it is a typing mistake. */
export function fieldsOf(struct, options = {}) {
  const fields = {};
  for (const [name, value] of Object.entries(options ?? {})) {
    if (value === undefined || value === null) continue;
    const field = snake(name);
    if (!struct.fields.includes(field) || field === 'struct_size')
      throw invalidArgument(`'${name}' is no option; there are ${struct.fields.filter((one) => !['struct_size', 'reserved'].includes(one)).map(camel).join(', ')}`);
    fields[field] = valueOf(field, value);
  }
  return fields;
}

/** The other way: what a call gives, with names as JavaScript writes them. u64 become numbers where they are counts. */
export function namesOf(values, { without = [] } = {}) {
  const left = ['struct_size', 'reserved', ...without];
  return Object.fromEntries(Object.entries(values).filter(([name]) => !left.includes(name)).map(([name, value]) => [
    camel(name),
    name.startsWith('is_') || name.startsWith('has_') ? value !== 0 : typeof value === 'bigint' ? Number(value) : value]));
}

/** Positions of a blade: [[base, tip], ...], [{ base, tip }, ...], or 6 numbers each in one typed array. */
export function blades(stroke) {
  if (ArrayBuffer.isView(stroke)) {
    if (stroke.length % 6 !== 0) throw invalidArgument(`a stroke has six numbers per position of the blade, and not ${stroke.length} in all`);
    return Array.from({ length: stroke.length / 6 }, (_, i) => ({ base: stroke.subarray(6 * i, 6 * i + 3), tip: stroke.subarray(6 * i + 3, 6 * i + 6) }));
  }
  return Array.from(stroke, blade);
}
export function blade(one) {
  if (ArrayBuffer.isView(one)) return blades(one)[0];
  return { base: triple(one.base ?? one[0], 'base of a blade'), tip: triple(one.tip ?? one[1], 'tip of a blade') };
}

/** Bytes of a view, an ArrayBuffer, or text. */
export function bytesOf(data) {
  if (data instanceof ArrayBuffer) return new Uint8Array(data);
  if (ArrayBuffer.isView(data)) return new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
  if (typeof data === 'string') return new TextEncoder().encode(data);
  throw invalidArgument('bytes are expected: a typed array, an ArrayBuffer or text');
}
