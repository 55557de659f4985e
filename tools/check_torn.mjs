#!/usr/bin/env node
// Proves, from the source file, what a GLB torn by Sunder tells of its vertices, or names what is wrong. Shares no code with
// Sunder and needs nothing but node 18. docs/torn_file.md has the record, the checks and their tolerances.
// Usage: node check_torn.mjs SOURCE.glb TORN.glb [--json]. Exit codes: 0 proved, 1 something is wrong, 2 cannot be checked.
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { dirname, relative, resolve } from 'node:path';
const EXTENSION = 'SUNDER_torn_mesh', SIDE = '_TEARSIDE', SIDES = [SIDE, '_FEATURE_ID_7353'], INFLUENCES = /^(JOINTS|WEIGHTS)_\d+$/;
const HALF_ULP = 2 ** -24, WEIGHT_TOLERANCE = 2 ** -20, AREA_TOLERANCE = 2 ** -20, MOST_FAULTS = 50;
const TYPES = { 5120: [Int8Array, 127], 5121: [Uint8Array, 255], 5122: [Int16Array, 32767], 5123: [Uint16Array, 65535], 5125: [Uint32Array], 5126: [Float32Array] };
const SHAPES = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
export class Unchecked extends Error {}  // the files do not allow a check
const need = (condition, text) => { if (!condition) throw new Unchecked(text); };
const isCount = (value) => Number.isSafeInteger(value) && value >= 0, sumOf = (values) => values.reduce((a, b) => a + b, 0);
const add = (map, key, value) => map.set(key, (map.get(key) ?? 0) + value), at = ({ values, size }, v) => [...values.subarray(v * size, (v + 1) * size)];
function fnv({ bytes, stride, size }, first, end, sum = 0x811C9DC5) {  // FNV-1a of 32 bits over the bytes of elements
  for (let i = first; i < end; ++i) for (let k = i * stride; k < i * stride + size; ++k) sum = Math.imul(sum ^ bytes[k], 0x01000193);
  return sum >>> 0;
}
export class Gltf {  // a document, whose accessors are decoded when they are asked for
  constructor(bytes, folder = null) {
    Object.assign(this, { bytes, folder, bin: null, memory: new Map() });
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), word = (offset) => view.getUint32(offset, true);
    const isGlb = bytes.length >= 12 && word(0) === 0x46546C67;
    let text = bytes;
    for (let begin = 20, end; isGlb && begin <= bytes.length; begin = end + 8) {
      end = begin + word(begin - 8);
      need(end <= bytes.length && word(8) <= bytes.length, `it is truncated: the chunk at byte ${begin - 8} ends beyond the file`);
      if (word(begin - 4) === 0x4E4F534A) text = bytes.subarray(begin, end);
      if (word(begin - 4) === 0x004E4942) this.bin ??= bytes.subarray(begin, end);
    }
    try { this.json = JSON.parse(new TextDecoder().decode(text)); } catch { /* undefined */ }
    need(this.json && typeof this.json === 'object', 'it is no glTF');
  }
  once(key, make) { return this.memory.has(key) ? this.memory.get(key) : this.memory.set(key, make()).get(key); }
  entry(list, index, found = isCount(index) && this.json[list]?.[index]) {
    return need(found && typeof found === 'object', `/${list}/${index} does not exist`) ?? found;
  }
  buffer(index) {
    const { uri } = this.entry('buffers', index), file = typeof uri === 'string' ? resolve(this.folder ?? '.', decodeURIComponent(uri)) : null;
    if (file === null) return need(this.bin, `/buffers/${index} has no bytes`) ?? this.bin;
    if (uri.startsWith('data:')) return this.once(`buffer ${index}`, () => Buffer.from(uri.slice(uri.indexOf(',') + 1), 'base64'));
    need(this.folder !== null && !relative(this.folder, file).startsWith('..'), `/buffers/${index} is outside of the file's folder`);
    return this.once(`buffer ${index}`, () => readFileSync(file));
  }
  elements(index, offset = 0, count, size, place) {  // of `size` bytes in a buffer view: element i is in `bytes` from i * stride on
    const view = this.entry('bufferViews', index), { byteOffset: begin = 0, byteLength: length, byteStride: stride = size } = view;
    need(!/meshopt/.test(Object.keys(view.extensions ?? {})), 'it is compressed; only uncompressed files can be checked');
    need([begin, length, stride, offset, count].every(isCount) && stride >= size, `${place}: its sizes are not valid`);
    const bytes = this.buffer(view.buffer), end = count === 0 ? 0 : offset + (count - 1) * stride + size;
    need(begin + length <= bytes.length && end <= length, `${place} reaches beyond its buffer`);
    return { bytes: bytes.subarray(begin + offset, begin + length), stride, size };
  }
  /** @return count, size (components), values (as doubles), unit (steps of one; 0: none), isFloat, stored (elements; null: none or sparse). */
  accessor(index) { return this.once(index, () => this.decode(this.entry('accessors', index), `/accessors/${index}`)); }
  decode({ bufferView, byteOffset, componentType, count, normalized, sparse, type }, place) {
    const [Type, steps] = TYPES[componentType] ?? [], size = SHAPES[type], limit = 16 * Math.max(this.bytes.length, 65536);
    need(Type && size && isCount(count) && count * size <= limit, `${place}: its type or count is not valid`);
    const unit = normalized ? steps ?? 0 : 0, values = new Float64Array(count * size), bytes = size * Type.BYTES_PER_ELEMENT;
    const unpack = (As, from, n, packed = new Uint8Array(n * from.size)) => {
      for (let i = 0; i < n; ++i) for (let k = 0; k < from.size; ++k) packed[i * from.size + k] = from.bytes[i * from.stride + k];
      return new As(packed.buffer);
    };
    const scaled = (raw) => (unit ? Float64Array.from(raw, (x) => Math.max(x / unit, -1)) : raw);
    const read = (of, As, n, bytesOfOne) => unpack(As, this.elements(of?.bufferView, of?.byteOffset, n, bytesOfOne, place), n);
    const stored = bufferView === undefined ? null : this.elements(bufferView, byteOffset, count, bytes, place);
    if (stored) values.set(scaled(unpack(Type, stored, count)));
    if (sparse !== undefined) {
      const n = sparse?.count, [Index] = TYPES[sparse?.indices?.componentType] ?? [];
      need(isCount(n) && n <= count && [Uint8Array, Uint16Array, Uint32Array].includes(Index), `${place}: its sparse part is not valid`);
      const some = scaled(read(sparse.values, Type, n, bytes)), where = read(sparse.indices, Index, n, Index.BYTES_PER_ELEMENT);
      need(where.every((element, i) => element < count && (i === 0 || element > where[i - 1])), `${place}: its sparse indices do not ascend`);
      where.forEach((element, i) => values.set(some.subarray(i * size, (i + 1) * size), element * size));
    }
    return { count, size, values, unit, isFloat: Type === Float32Array, stored: sparse === undefined ? stored : null };
  }
  vertices(primitive) {  // accessors in the order of their names, and those of each morph target
    need(!primitive.extensions?.KHR_draco_mesh_compression, 'it is compressed; only uncompressed files can be checked');
    const read = (of) => new Map(Object.keys(of).sort().map((name) => [name, this.accessor(of[name])]));
    const attributes = read(primitive.attributes ?? {}), targets = (primitive.targets ?? []).map(read), count = attributes.get('POSITION')?.count;
    need(isCount(count) && [attributes, ...targets].every((of) => [...of.values()].every((one) => one.count === count)), 'attributes differ in length');
    return { count, attributes, targets };
  }
  triangles({ indices, mode = 4 }, vertexCount) {
    const v = indices === undefined ? Array.from({ length: vertexCount }, (_, i) => i) : this.accessor(indices).values, step = mode === 4 ? 3 : 1;
    return Array.from({ length: mode < 4 ? 0 : Math.max(Math.floor((v.length - 3) / step) + 1, 0) }, (_, t) => t * step)
      .map((i) => (mode === 6 ? [v[0], v[i + 1], v[i + 2]] : mode === 5 && i % 2 ? [v[i + 1], v[i], v[i + 2]] : [v[i], v[i + 1], v[i + 2]]));
  }
}
/** The weights of each vertex by slot: as stored, with wrong(vertex, text) for what is not valid; without `wrong` their sums are one. */
function influences({ count, attributes }, slots, wrong = null) {
  const all = Array.from({ length: count }, () => new Map()), unit = attributes.get('WEIGHTS_0')?.unit;
  for (let set = 0; attributes.has(`WEIGHTS_${set}`); ++set) {
    const weights = attributes.get(`WEIGHTS_${set}`), joints = attributes.get(`JOINTS_${set}`);
    need(joints?.size === 4 && weights.size === 4, `JOINTS_${set} and WEIGHTS_${set} do not have four components`);
    for (let i = 0; i < 4 * count; ++i) {
      const slot = joints.values[i], weight = weights.values[i], of = all[i >> 2];
      if (wrong && (slot >= slots || !(weight >= 0) || (weight === 0 ? slot !== 0 : of.has(slot)))) wrong(i >> 2, `slot ${slot} has ${weight}`);
      if (weight > 0) add(of, slot, weight);
    }
  }
  const sums = all.map((of) => sumOf([...of.values()]));
  if (wrong) sums.forEach((sum, v) => Math.abs(sum - 1) <= (unit ? 1e-9 : 2e-7 * Math.max(all[v].size, 1)) || wrong(v, `they sum to ${sum}`));
  return wrong ? all : all.map((of, v) => new Map([...of].map(([slot, weight]) => [slot, weight / sums[v]])));
}
function compareWeights(full, written, { unit, maximum, isLimited, isCertified }) {  // with what the parents give, but the smallest: what differs, or null
  const tolerance = (unit ? 1 / unit : 0) + WEIGHT_TOLERANCE, slots = [...written.keys()], strange = slots.find((slot) => !full.has(slot));
  if (strange !== undefined) return `bone ${strange} moves none of its parents`;
  const kept = slots.map((slot) => full.get(slot)), divisor = isCertified ? 1 : sumOf(kept), least = Math.min(...kept);
  const mayDrop = isCertified ? Infinity : isLimited || (maximum > 0 && written.size >= maximum) ? least : 0;
  const missing = [...full].find(([slot, weight]) => !written.has(slot) && weight > mayDrop + tolerance);
  if (missing) return `bone ${missing[0]} with ${missing[1]} is missing`;
  const isRight = (less) => less <= tolerance && (isCertified || less >= -tolerance);  // certified ones may have taken over what was left out
  const wrong = slots.find((slot) => !isRight(full.get(slot) / divisor - written.get(slot)));
  return wrong === undefined ? null : `bone ${wrong} has ${written.get(wrong)}, expected ${full.get(wrong) / divisor}`;
}
function compareMean(of, { values, size }, v, { isDirection, isLabel, slack, bound }) {  // the value of a vertex with the mean of its parents': what differs, or null
  const value = (vertex, c) => values[vertex * size + c], mean = new Float64Array(size);
  for (const [parent, part] of of) for (let c = 0; c < size; ++c) mean[c] += part * value(parent, c);
  const length = isDirection ? Math.hypot(mean[0], mean[1], mean[2]) : 1, isNearest = ([, part]) => of.every(([, other]) => part >= other - 4 * HALF_ULP);
  for (let c = 0; c < size; ++c) {
    let [low, high, got, expected] = [Infinity, -Infinity, value(v, c), mean[c] / length];
    for (const [parent] of of) [low, high] = [Math.min(low, value(parent, c)), Math.max(high, value(parent, c))];
    const rounding = HALF_ULP * (1.01 * Math.abs(expected) + 2 * (high - low)) + slack * Math.max(-low, high) + bound * 1.0001 + 2 ** -149;
    const isRight = isLabel || (isDirection && c === 3) ? of.some((one) => isNearest(one) && value(one[0], c) === got) :
      Math.abs(got - expected) <= (isDirection ? 8 * HALF_ULP * (1 + 1 / length) : rounding);
    if (!isRight && length > 1e-6) return `component ${c} is ${got}, expected ${expected}`;  // shorter: opposite directions cancel
  }
  return null;
}
class TornMesh {  // the primitives of a torn file that share vertices
  constructor(source, torn, record, primitive, options, say) {
    Object.assign(this, { source, torn, record, options, say, pools: new Map() });
    const { primitives } = this.sourceMesh = source.entry('meshes', record.sourceMesh);
    need(Array.isArray(record.sourcePrimitives) && record.sourcePrimitives.every((p) => primitives?.[p]), 'the source has no such primitive');
    Object.assign(this, { before: source.vertices(primitives[record.sourcePrimitives[0]]), after: torn.vertices(primitive) });
    const first = this.first = this.before.count, created = this.after.count - first;
    need(record.firstVertex === first && created >= 0, `the source has ${first} vertices, the record says ${record.firstVertex}`);
    for (const name of ['kinds', 'places', 'parts', 'parents', 'reduced', 'remaining', 'sums'])
      this[name] = record[name] === undefined ? [] : torn.accessor(record[name]).values;
    const { kinds, places, parts, parents, reduced, remaining, sums } = this, isWhole = kinds.length === created && places.length === created;
    need(isWhole && parents.length === parts.length && remaining.length === reduced.length && (record.sums === undefined || sums.length === created), 'columns differ in length');
    this.counts = { source: first, derived: 0, rims: 0, inside: 0, fitted: 0, triangles: 0, reduced: reduced.length };
    this.readOrigins();
    this.checkAttributes('', this.before.attributes, this.after.attributes);
    this.before.targets.forEach((target, t) => this.checkAttributes(`target ${t} `, target, this.after.targets[t] ?? new Map()));
    if (this.before.attributes.has('WEIGHTS_0')) this.checkWeights();
    this.checkSums();
    const shares = new Map([...reduced].map((triangle, i) => [triangle, remaining[i]]));
    const triangles = record.sourcePrimitives.flatMap((p) => source.triangles(primitives[p], first).map((corners) => [p, corners]));
    triangles.filter(([, corners]) => Math.max(...corners) < first).forEach((one, i) => { this.poolOf(...one).expected += shares.get(i) ?? 1; });
  }
  readOrigins() {  // per new vertex its parents, `of`, and its place between vertices of the source, `shares`; null inside of walls and caps
    const origins = this.origins = [];
    this.places.forEach((number, i) => {
      const v = this.first + i, kind = this.kinds[i], policy = kind & 3, values = kind >> 2 & 3, place = 3 * number, shares = new Map();
      const parts = [...this.parts.slice(place, place + 3)], parents = [...this.parents.slice(place, place + 3)], sum = sumOf(parts);
      const isPlace = parents.length === 3 && parents.every((parent) => parent < v) && parts.every((part) => part >= 0) && Math.abs(sum - 1) <= 4 * HALF_ULP;
      const isValid = kind < 32 && (values === 2 ? place === this.parts.length : values < 2 && isPlace);
      if (!isValid) this.say(v, 'record', `kind ${kind}, parents ${parents}, parts ${parts}`);
      const of = isValid && values < 2 ? parents.map((parent, k) => [parent, parts[k] / sum]).filter(([, part]) => part > 0) : null;
      for (const [parent, part] of of ?? [])
        for (const [vertex, share] of parent < this.first ? [[parent, 1]] : origins[parent - this.first].shares ?? [[NaN, 1]]) add(shares, vertex, part * share);
      origins.push({ of, values, place, policy, isFitted: policy % 3 > 0, isLimited: (kind & 16) !== 0, shares: of && !shares.has(NaN) && shares.size <= 3 ? shares : null });
      for (const name of [['derived', 'rims', 'inside'][of ? values : 2], ...(policy % 3 > 0 ? ['fitted'] : [])]) this.counts[name] += 1;
    });
  }
  checkAttributes(prefix, before, after) {
    for (const [name, now] of after)
      if (!before.has(name) && !SIDES.includes(name) && !(INFLUENCES.test(name) && before.has('WEIGHTS_0')) && !(prefix && now.values.every((x) => x === 0)))
        this.say(null, prefix + name, 'the source does not have it');
    for (const [name, old] of before) {
      if (INFLUENCES.test(name) || SIDES.includes(name)) continue;
      const now = after.get(name), isPosition = name === 'POSITION', isDirection = !prefix && (name === 'NORMAL' || name === 'TANGENT');
      if (now?.size !== old.size) { this.say(null, prefix + name, 'is missing, or has another number of components'); continue; }
      for (let i = 0; i < old.values.length; ++i) {  // a vertex of the source: bit for bit, but integers became floats, and directions of unit length
        const difference = Math.abs(old.values[i] - now.values[i]), v = Math.floor(i / old.size);
        if (difference === 0 || (!old.isFloat && difference <= 2 * HALF_ULP * Math.abs(old.values[i]))) continue;
        const [x, y, z] = isDirection && i % old.size < 3 ? at(old, v) : [NaN];
        if (!(Math.abs(old.values[i] / Math.hypot(x, y, z) - now.values[i]) <= 4 * HALF_ULP)) this.say(v, prefix + name, `${at(now, v)}, the source has ${at(old, v)}`);
      }
      this.origins.forEach(({ of, values, isFitted }, i) => {
        const parents = (of ?? []).filter(([parent]) => parent >= this.first).map(([parent]) => this.origins[parent - this.first]);
        if (!of || (values === 1 && !isPosition)) return;
        const isFree = isPosition && !prefix && (isFitted || parents.some((parent) => parent.isFitted)), isLabel = name.startsWith('_') && !old.isFloat && !old.unit;
        const aside = isPosition && !prefix ? 4 * HALF_ULP * Math.max(...at(now, this.first + i).map(Math.abs)) : 0;  // to other points of the place, or off a face's edge
        const text = compareMean(of, now, this.first + i, { isDirection, isLabel, slack: parents.length > 0 ? HALF_ULP : 0, bound: isFree ? this.options.placeBound : aside });
        if (text) this.say(this.first + i, prefix + name, text);
      });
    }
  }
  checkWeights() {
    const say = (v, text) => this.say(v, 'WEIGHTS', text), written = influences(this.after, this.options.slots, say), twins = new Map();
    const full = [...this.source.once(this.before.attributes, () => influences(this.before))], bones = new Map(full.flatMap((of) => [...of]));
    const position = this.after.attributes.get('POSITION'), options = { ...this.options, unit: this.after.attributes.get('WEIGHTS_0')?.unit, maximum: this.record.influences };
    for (let v = 0; v < this.after.count; ++v) {
      const { of, place, policy, isLimited } = this.origins[v - this.first] ?? { of: null, isLimited: false };
      const isFree = (one) => one && (!one.of || one.policy === 2);  // fitted, or inside of a wall or cap: the file may not have all its weights
      if (v >= this.first) full[v] = new Map(of ? [] : written[v]);
      for (const [parent, part] of of ?? []) full[parent].forEach((weight, slot) => add(full[v], slot, part * weight));
      const isChecked = ![v, ...(of ?? []).map(([parent]) => parent)].some((one) => isFree(this.origins[one - this.first]));
      const strange = [...written[v].keys()].find((slot) => !(policy === 2 && of ? full[v] : bones).has(slot));
      const text = isChecked ? compareWeights(full[v], written[v], { ...options, isLimited }) : strange === undefined ? null : `bone ${strange} moves none of its parents`;
      if (text) say(v, text);
      if (!of) continue;
      const state = [...at(position, v), ...[...written[v]].sort(([x], [y]) => x - y).flat()], twin = twins.get(place) ?? twins.set(place, state).get(place);
      const reach = 8 * HALF_ULP * Math.max(4, ...of.flatMap(([parent]) => at(position, parent)).map(Math.abs));  // of another vertex of the same point
      if (twin !== state && (twin.length !== state.length || state.some((x, i) => !(Math.abs(x - twin[i]) <= reach)))) say(v, 'it parts from another vertex of the same point');
    }
  }
  checkSums() {  // what the source does not tell is as it was written
    const stored = (of) => [...of].filter(([name, one]) => one.stored && !SIDES.includes(name)).map(([, one]) => one.stored);
    const all = [this.after.attributes, ...this.after.targets].flatMap(stored), sides = this.after.attributes.get(SIDE)?.values ?? [];
    const sumOf = (v) => all.reduce((begun, one) => fnv(one, v, v + 1, begun), undefined), text = 'its bytes are not those that were written';
    this.sums.forEach((sum, i) => sum === sumOf(this.first + i) || this.say(this.first + i, 'sums', text));
    const ofSides = fnv({ bytes: new Uint8Array(Float32Array.from(sides).buffer), stride: 4, size: 4 }, 0, sides.length);
    const appended = this.after.targets.slice(this.before.targets.length).flatMap(stored);
    if (appended.reduce((begun, one) => fnv(one, 0, this.after.count, begun), ofSides) !== this.record.restSum) this.say(null, SIDE, 'or an appended morph target is not that which was written');
  }
  poolOf(primitive, corners) {  // a triangle of the source, its least vertex first, and the share of it that is expected and found
    const [a, b, c] = corners, least = Math.min(a, b, c), turned = a === least ? corners : b === least ? [b, c, a] : [c, a, b], key = `${primitive},${turned}`;
    return this.pools.get(key) ?? this.pools.set(key, { corners: turned, expected: 0, covered: 0, parts: 0 }).get(key);
  }
  checkTriangles(primitive) {
    const { sourcePrimitive: p, indexSum } = primitive.extensions[EXTENSION], { stored, count } = this.torn.accessor(primitive.indices), isWall = p === undefined;
    if (!stored || fnv(stored, 0, count) !== indexSum) this.say(null, 'indices', 'are not those that were written');
    if (!isWall && this.sourceMesh.primitives[p]?.material !== primitive.material) this.say(null, 'material', 'differs from the source');
    this.counts.triangles += count / 3;
    const texts = this.torn.triangles(primitive, this.after.count).map((corners) => [corners[0], this.triangleFault(corners, p, isWall)]);
    texts.forEach(([corner, text], t) => text && this.say(corner, 'indices', `triangle ${t} ${text}`));
  }
  triangleFault(corners, p, isWall) {
    if (corners.some((v) => v >= this.after.count || (isWall && v < this.first))) return 'has a vertex that does not exist, or is not of its wall or cap';
    if (isWall) return null;
    const shares = corners.map((v) => (v < this.first ? new Map([[v, 1]]) : this.origins[v - this.first].shares));
    const vertices = [...new Set(shares.flatMap((of) => [...(of ?? new Map([[NaN, 1]])).keys()]))];
    if (vertices.includes(NaN) || vertices.length > 3) return 'lies in no triangle of the source';
    if (vertices.length < 3) return this.pools.has(`${p},${corners}`) || new Set(corners).size < 3 ? null : 'has no area';
    const [a, b, c] = shares.map((of) => vertices.map((vertex) => of.get(vertex) ?? 0));
    const area = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    const pool = this.poolOf(p, area >= 0 ? vertices : [vertices[0], vertices[2], vertices[1]]);
    Object.assign(pool, { covered: pool.covered + Math.abs(area), parts: pool.parts + 1 });
    return pool.expected === 0 && Math.abs(area) > AREA_TOLERANCE ? 'lies in no triangle of the source, or is turned over' : null;
  }
  checkCover() {
    const isOff = ({ corners, expected, covered, parts }) => new Set(corners).size === 3 && !(Math.abs(covered - expected) <= AREA_TOLERANCE * (1 + parts));
    const texts = [...this.pools.values()].filter(isOff).map((pool) => [pool.corners[0], `of the triangle ${pool.corners} of the source ${pool.covered} is there, expected ${pool.expected}`]);
    texts.forEach(([corner, text]) => this.say(corner, 'indices', text));
  }
}
function checkRig(source, torn, say) {  // nodes and skins are those of the source: weights mean the same bones, at the same places
  const binds = (file, { joints, inverseBindMatrices: index }) => `${joints} ${index === undefined ? '' : file.accessor(index).values}`;
  (source.json.nodes ?? []).forEach((node, n) => {
    const other = torn.json.nodes?.[n] ?? {}, hasSkin = node.skin !== undefined && other.mesh !== undefined, wrong = [];
    for (const key of ['translation', 'rotation', 'scale', 'matrix', 'children']) if (JSON.stringify(node[key]) !== JSON.stringify(other[key])) wrong.push(key);
    if (hasSkin && binds(source, source.entry('skins', node.skin)) !== binds(torn, torn.entry('skins', other.skin))) wrong.push('skin');
    wrong.forEach((attribute) => say({ node: n, name: node.name, attribute, text: 'differs from the source' }));
  });
}
function isUntouched(source, torn, primitive, node) {  // a primitive without a record is one of the source, number by number
  const same = (a, b) => a?.values.length === b?.values.length && (a?.values ?? []).every((x, i) => x === b.values[i]);
  const allSame = (a, b) => a.size === b?.size && [...a].every(([name, one]) => same(one, b.get(name)));
  const indices = (file, of) => (of.indices === undefined ? undefined : file.accessor(of.indices)), now = torn.vertices(primitive);
  const isSame = (one, of) => same(indices(source, one), indices(torn, primitive)) && allSame(of.attributes, now.attributes) && of.targets.every((target, t) => allSame(target, now.targets[t]));
  return source.entry('meshes', source.entry('nodes', node).mesh).primitives.some((one) => isSame(one, source.vertices(one)));
}
/** Checks a torn file against its source. @return { faults: [{ mesh, primitive, vertex, attribute, text }], meshes: counts }. Throws Unchecked. */
export function checkTorn(source, torn) {
  const faults = [], groups = new Map(), root = torn.json.extensions?.[EXTENSION], nodes = torn.json.nodes ?? [];
  need(root?.version === 1, `it has no record ${EXTENSION} of version 1`);
  const digest = source.once('digest', () => createHash('sha256').update(source.bytes).digest('hex')), say = (fault) => faults.length < MOST_FAULTS && faults.push(fault);
  need(root.source?.sha256 === digest, `it was torn from another file: ${JSON.stringify(root.source)}`);
  checkRig(source, torn, say);
  (torn.json.meshes ?? []).forEach((mesh, m) => (mesh.primitives ?? []).forEach((primitive, p) => {
    const record = primitive.extensions?.[EXTENSION], n = nodes.findIndex((one) => one.mesh === m), place = { mesh: m, name: mesh.name, primitive: p };
    if (n < 0) return;
    if (!record) { if (!isUntouched(source, torn, primitive, n)) say({ ...place, vertex: null, attribute: 'record', text: 'is missing, but it differs from the source' }); return; }
    const options = { slots: nodes[n].skin === undefined ? 0 : torn.entry('skins', nodes[n].skin).joints.length, isCertified: root.certifiedBound !== undefined, placeBound: root.placeBound ?? Infinity };
    const key = JSON.stringify([m, primitive.attributes, primitive.targets, { ...record, indexSum: undefined, sourcePrimitive: undefined }]);
    const sayOf = (vertex, attribute, text) => say({ ...place, vertex, attribute, text }), known = groups.get(key);
    (known ?? groups.set(key, new TornMesh(source, torn, record, primitive, options, sayOf)).get(key)).checkTriangles(primitive);
  }));
  groups.forEach((group) => group.checkCover());
  return { faults, meshes: [...groups].map(([key, { counts }]) => ({ mesh: JSON.parse(key)[0], ...counts })), certifiedBound: root.certifiedBound, placeBound: root.placeBound };
}
export function openGltf(file) {
  try { return new Gltf(readFileSync(file), dirname(resolve(file))); } catch ({ message }) { throw new Unchecked(`${file}: ${message}`); } }
function main(args) {
  const files = args.filter((arg) => arg !== '--json'), placeOf = ({ node, mesh, name = '', primitive, vertex }) =>
    (node === undefined ? `mesh ${mesh} '${name}', primitive ${primitive}${vertex === null ? '' : `, vertex ${vertex}`}` : `node ${node} '${name}'`);
  need(files.length === 2, 'usage: node check_torn.mjs SOURCE.glb TORN.glb [--json]');
  const result = checkTorn(openGltf(files[0]), openGltf(files[1])), { faults, meshes } = result, end = faults.length === 0 ? 'proved' : `wrong: ${faults.length}`;
  const lines = meshes.map(({ mesh, ...counts }) => `mesh ${mesh}: ${Object.entries(counts).map((count) => count.join(' ')).join(', ')}`);
  lines.push(...faults.map((fault) => `${placeOf(fault)}: ${fault.attribute}: ${fault.text}`), end + (faults.length < MOST_FAULTS ? '' : ' or more'));
  console.log(files.length < args.length ? JSON.stringify(result) : lines.join('\n'));
  return faults.length === 0 ? 0 : 1;
}
if (process.argv[1]?.endsWith('check_torn.mjs')) {
  try { process.exitCode = main(process.argv.slice(2)); } catch (error) { process.exitCode = (console.error(`check_torn: ${error.message}`), 2); }
}
