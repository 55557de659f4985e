#!/usr/bin/env node
// Proves, from the source file, what a GLB torn by Sunder tells of its vertices, or names what is wrong. Shares no code with
// Sunder and needs nothing but node 18. docs/torn_file.md has the record, the checks and their tolerances.
// Usage: node check_torn.mjs SOURCE.glb TORN.glb [--json]. Exit codes: 0 proved, 1 something is wrong, 2 cannot be checked.
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { dirname, relative, resolve } from 'node:path';
const EXTENSION = 'SUNDER_torn_mesh', SIDE = '_TEARSIDE', SCAR = '_SCAR', SIDES = [SIDE, '_FEATURE_ID_7353'], INFLUENCES = /^(JOINTS|WEIGHTS)_\d+$/;
const HALF_ULP = 2 ** -24, WEIGHT_TOLERANCE = 2 ** -20, AREA_TOLERANCE = 2 ** -20, MOST_FAULTS = 50;
const TYPES = { 5120: [Int8Array, 127], 5121: [Uint8Array, 255], 5122: [Int16Array, 32767], 5123: [Uint16Array, 65535], 5125: [Uint32Array], 5126: [Float32Array] }, SHAPES = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
export class Unchecked extends Error {}  // the files do not allow a check
const digestOf = (bytes) => createHash('sha256').update(bytes).digest('hex'), need = (condition, text) => { if (!condition) throw new Unchecked(text); };
const isCount = (value) => Number.isSafeInteger(value) && value >= 0, sumOf = (values) => values.reduce((a, b) => a + b, 0);
const add = (map, key, value) => map.set(key, (map.get(key) ?? 0) + value), at = ({ values, size }, v) => [...values.subarray(v * size, (v + 1) * size)];
function fnv({ bytes, stride, size }, first, end, sum = 0x811C9DC5) {  // FNV-1a of 32 bits over the bytes of elements
  for (let i = first; i < end; ++i) for (let k = i * stride; k < i * stride + size; ++k) sum = Math.imul(sum ^ bytes[k], 0x01000193);
  return sum >>> 0;
}
export class Gltf {  // a document, whose accessors are decoded when they are asked for
  constructor(bytes, folder = null, text = bytes) {
    const { buffer, byteOffset, byteLength } = Object.assign(this, { bytes, folder, bin: null, memory: new Map() }).bytes, view = new DataView(buffer, byteOffset, byteLength), word = (offset) => view.getUint32(offset, true), isGlb = bytes.length >= 12 && word(0) === 0x46546C67;
    for (let begin = 20, end; isGlb && begin <= bytes.length && (end = begin + word(begin - 8)); begin = end + 8) {
      need(end <= bytes.length && word(8) <= bytes.length, `it is truncated: the chunk at byte ${begin - 8} ends beyond the file`);
      if (word(begin - 4) === 0x4E4F534A) text = bytes.subarray(begin, end);
      if (word(begin - 4) === 0x004E4942) this.bin ??= bytes.subarray(begin, end);
    }
    try { this.json = JSON.parse(new TextDecoder().decode(text)); } catch { /* undefined */ } finally { need(this.json && typeof this.json === 'object', 'it is no glTF'); }
  }
  once(key, make) { return this.memory.has(key) ? this.memory.get(key) : this.memory.set(key, make()).get(key); }
  entry(list, index, found = isCount(index) && this.json[list]?.[index]) { return need(found && typeof found === 'object', `/${list}/${index} does not exist`) ?? found; }
  buffer(index) {
    const { uri } = this.entry('buffers', index), file = typeof uri === 'string' ? resolve(this.folder ?? '.', decodeURIComponent(uri)) : null;
    if (file === null) return need(this.bin, `/buffers/${index} has no bytes`) ?? this.bin;
    if (uri.startsWith('data:')) return this.once(`buffer ${index}`, () => Buffer.from(uri.slice(uri.indexOf(',') + 1), 'base64'));
    return need(this.folder !== null && !relative(this.folder, file).startsWith('..'), `/buffers/${index} is outside of the file's folder`) ?? this.once(`buffer ${index}`, () => readFileSync(file));
  }
  elements(index, offset = 0, count, size, place) {  // of `size` bytes in a buffer view: element i is in `bytes` from i * stride on
    const view = this.entry('bufferViews', index), { byteOffset: begin = 0, byteLength: length, byteStride: stride = size } = view;
    need(!/meshopt/.test(Object.keys(view.extensions ?? {})), 'it is compressed; only uncompressed files can be checked');
    need([begin, length, stride, offset, count].every(isCount) && stride >= size, `${place}: its sizes are not valid`);
    const bytes = this.buffer(view.buffer), end = count === 0 ? 0 : offset + (count - 1) * stride + size;
    return need(begin + length <= bytes.length && end <= length, `${place} reaches beyond its buffer`) ?? { bytes: bytes.subarray(begin + offset, begin + length), stride, size };
  }
  /** @return count, size (components), values (as doubles), unit (steps of one; 0: none), isFloat, stored (elements; null: none or sparse). */
  accessor(index) { return this.once(index, () => this.decode(this.entry('accessors', index), `/accessors/${index}`)); }
  decode({ bufferView, byteOffset, componentType, count, normalized, sparse, type }, place) {
    const [Type, steps] = TYPES[componentType] ?? [], size = SHAPES[type], limit = 16 * Math.max(this.bytes.length, 65536);
    need(Type && size && isCount(count) && count * size <= limit, `${place}: its type or count is not valid`);
    const unit = normalized ? steps ?? 0 : 0, values = new Float64Array(count * size), bytes = size * Type.BYTES_PER_ELEMENT;
    const pack = ({ bytes: of, stride, size: one }, n, packed = new Uint8Array(n * one)) => { for (let i = 0; i < n; ++i) packed.set(of.subarray(i * stride, i * stride + one), i * one); return packed; };
    const unpack = (As, from, n) => new As(pack(from, n).buffer);
    const scaled = (raw) => (unit ? Float64Array.from(raw, (x) => Math.max(x / unit, -1)) : raw), read = (of, As, n, bytesOfOne) => unpack(As, this.elements(of?.bufferView, of?.byteOffset, n, bytesOfOne, place), n);
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
    const read = (of) => new Map(Object.keys(of).sort().map((name) => [name, this.accessor(of[name])]));
    const attributes = read(primitive.attributes ?? {}), targets = (primitive.targets ?? []).map(read), count = attributes.get('POSITION')?.count;
    need(isCount(count) && [attributes, ...targets].every((of) => [...of.values()].every((one) => one.count === count)), 'attributes differ in length');
    return need(!primitive.extensions?.KHR_draco_mesh_compression, 'it is compressed; only uncompressed files can be checked') ?? { count, attributes, targets };
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
  const kept = slots.map((slot) => full.get(slot)), divisor = isCertified ? 1 : sumOf(kept), least = Math.min(...kept), mayDrop = isCertified ? Infinity : isLimited || (maximum > 0 && written.size >= maximum) ? least : 0;
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
    const isRight = isLabel || (isDirection && c === 3) ? of.some((one) => isNearest(one) && value(one[0], c) === got) : Math.abs(got - expected) <= (isDirection ? 8 * HALF_ULP * (1 + 1 / length) : rounding);
    if (!isRight && length > 1e-6) return `component ${c} is ${got}, expected ${expected}`;  // shorter: opposite directions cancel
  }
  return null;
}
class TornMesh {  // the primitives of a torn file that share vertices
  constructor(source, torn, record, primitive, options, say) {
    Object.assign(this, { source, torn, record, options, say, pools: new Map(), primitives: 0, mixed: 0, origins: [] });
    const { primitives } = this.sourceMesh = source.entry('meshes', record.sourceMesh);
    need(Array.isArray(record.sourcePrimitives) && record.sourcePrimitives.every((p) => primitives?.[p]), 'the source has no such primitive');
    Object.assign(this, { before: source.vertices(primitives[record.sourcePrimitives[0]]), after: torn.vertices(primitive) });
    const first = this.first = this.before.count, created = this.after.count - first;
    need(record.firstVertex === first && created >= 0, `the source has ${first} vertices, the record says ${record.firstVertex}`);
    for (const name of ['kinds', 'places', 'parts', 'parents', 'reduced', 'remaining', 'sums']) this[name] = record[name] === undefined ? [] : torn.accessor(record[name]).values;
    const { kinds, places, parts, parents, reduced, remaining, sums } = this, isWhole = kinds.length === created && places.length === created;
    need(isWhole && parents.length === parts.length && remaining.length === reduced.length && (record.sums === undefined || sums.length === created), 'columns differ in length');
    this.readOrigins(this.counts = { source: first, derived: 0, rims: 0, inside: 0, fitted: 0, triangles: 0, reduced: reduced.length });
    this.checkAttributes('', this.before.attributes, this.after.attributes);
    this.before.targets.forEach((target, t) => this.checkAttributes(`target ${t} `, target, this.after.targets[t] ?? new Map()));
    if (this.before.attributes.has('WEIGHTS_0')) this.checkWeights();
    this.checkSums();
    const shares = new Map([...reduced].map((triangle, i) => [triangle, remaining[i]])), triangles = record.sourcePrimitives.flatMap((p) => source.triangles(primitives[p], first).map((corners) => [p, corners]));
    triangles.filter(([, corners]) => Math.max(...corners) < first).forEach((one, i) => { this.poolOf(...one).expected += shares.get(i) ?? 1; });
  }
  readOrigins(counts) {  // per new vertex its parents, `of`, and its place between vertices of the source, `shares`; null inside of walls and caps
    this.places.forEach((number, i) => {
      const v = this.first + i, kind = this.kinds[i], policy = kind & 3, values = kind >> 2 & 3, place = 3 * number, shares = new Map();
      const parts = [...this.parts.slice(place, place + 3)], parents = [...this.parents.slice(place, place + 3)], sum = sumOf(parts);
      const isPlace = parents.length === 3 && parents.every((parent) => parent < v) && parts.every((part) => part >= 0) && Math.abs(sum - 1) <= 4 * HALF_ULP;
      const isValid = kind < 32 && (values === 2 ? place === this.parts.length : values < 2 && isPlace);
      if (!isValid) this.say(v, 'record', `kind ${kind}, parents ${parents}, parts ${parts}`);
      const of = isValid && values < 2 ? parents.map((parent, k) => [parent, parts[k] / sum]).filter(([, part]) => part > 0) : null;
      for (const [parent, part] of of ?? []) for (const [vertex, share] of parent < this.first ? [[parent, 1]] : this.origins[parent - this.first].shares ?? [[NaN, 1]]) add(shares, vertex, part * share);
      this.origins.push({ of, values, place, policy, isFitted: policy % 3 > 0, isLimited: (kind & 16) !== 0, shares: of && !shares.has(NaN) && shares.size <= 3 ? shares : null });
      for (const name of [['derived', 'rims', 'inside'][of ? values : 2], ...(policy % 3 > 0 ? ['fitted'] : [])]) counts[name] += 1;
    });
  }
  checkAttributes(prefix, before, after) {
    const isNew = ([name, now]) => !before.has(name) && ![...SIDES, SCAR].includes(name) && !(INFLUENCES.test(name) && before.has('WEIGHTS_0')) && !(prefix && now.values.every((x) => x === 0));
    [...after].filter(isNew).forEach(([name]) => this.say(null, prefix + name, 'the source does not have it'));
    for (const [name, old] of [...before].filter(([name]) => !INFLUENCES.test(name) && !SIDES.includes(name))) {
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
      need((this.mixed += full[v].size) < 2 ** 24, 'its new vertices mix too many bones');
      const isChecked = ![v, ...(of ?? []).map(([parent]) => parent)].some((one) => isFree(this.origins[one - this.first])), strange = [...written[v].keys()].find((slot) => !(policy === 2 && of ? full[v] : bones).has(slot));
      const text = isChecked ? compareWeights(full[v], written[v], { ...options, isLimited }) : strange === undefined ? null : `bone ${strange} moves none of its parents`;
      if (text) say(v, text); if (!of) continue;
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
    const ofSides = fnv({ bytes: new Uint8Array(Float32Array.from(sides).buffer), stride: 4, size: 4 }, 0, sides.length), appended = this.after.targets.slice(this.before.targets.length).flatMap(stored);
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
    [this.counts.triangles, this.primitives] = [this.counts.triangles + count / 3, this.primitives + 1];
    const texts = this.torn.triangles(primitive, this.after.count).map((corners) => [this.triangleFault(corners, p, isWall), corners[0]]);
    texts.forEach(([text, corner], t) => text && this.say(corner, 'indices', `triangle ${t} ${text}`));
  }
  triangleFault(corners, p, isWall) {
    if (isWall || corners.some((v) => v >= this.after.count)) return corners.every((v) => v >= this.first && v < this.after.count) ? null : 'has a vertex that does not exist, or is not of its wall or cap';
    const shares = corners.map((v) => (v < this.first ? new Map([[v, 1]]) : this.origins[v - this.first].shares)), vertices = [...new Set(shares.flatMap((of) => [...(of ?? new Map([[NaN, 1]])).keys()]))];
    if (vertices.includes(NaN) || vertices.length > 3) return 'lies in no triangle of the source';
    if (vertices.length < 3) return this.pools.has(`${p},${corners}`) || new Set(corners).size < 3 ? null : 'has no area';
    const [a, b, c] = shares.map((of) => vertices.map((vertex) => of.get(vertex) ?? 0)), area = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    const pool = this.poolOf(p, area >= 0 ? vertices : [vertices[0], vertices[2], vertices[1]]);
    Object.assign(pool, { covered: pool.covered + Math.abs(area), parts: pool.parts + 1 });
    return pool.expected === 0 && Math.abs(area) > AREA_TOLERANCE ? 'lies in no triangle of the source, or is turned over' : null;
  }
  checkCover() {
    if (this.primitives !== this.record.primitives) this.say(null, 'record', `of ${this.record.primitives} primitives ${this.primitives} are there`);
    for (const { corners, expected, covered, parts } of this.pools.values())
      if (new Set(corners).size === 3 && !(Math.abs(covered - expected) <= AREA_TOLERANCE * (1 + parts))) this.say(corners[0], 'indices', `of the triangle ${corners} of the source ${covered} is there, expected ${expected}`);
  }
}
class Shown {  // what a file shows besides torn meshes, as texts that are equal in source and torn file
  constructor(file, source, torn, isGone) { Object.assign(this, { file, source, torn, isGone, nodes: file.json.nodes ?? [] }); }
  text(one) { return this.file.once(one, () => `${one.size} ${digestOf(new Uint8Array(one.values.map((x) => (one.unit ? Math.fround(x) : x) + 0).buffer))}`); }
  valuesOf(index) { return index === undefined ? undefined : this.text(this.file.accessor(index)); }
  primitive(of, targetCount) {  // of its morph targets those that the source has; others must be zero
    const { attributes, targets } = this.file.vertices(of), texts = (all) => [...all].map(([name, one]) => [name, this.text(one)]);
    const isZero = targets.slice(targetCount).every((target) => [...target.values()].every(({ values }) => values.every((x) => x === 0)));
    return JSON.stringify([of.mode ?? 4, of.material, isZero, this.valuesOf(of.indices), texts(attributes), targets.slice(0, targetCount).map(texts)]);
  }
  targetCount(n, { json } = this.source) { return json.meshes?.[json.nodes?.[n]?.mesh]?.primitives?.[0]?.targets?.length ?? 0; }
  node(n) {  // what each member means
    const { mesh, skin, weights = this.file.json.meshes?.[mesh]?.weights ?? [], extensions, ...node } = this.nodes[n], isShown = mesh !== undefined && !this.isGone(n);
    const bind = () => [this.file.entry('skins', skin)].map((of) => [of.joints, this.valuesOf(of.inverseBindMatrices)]), ofTargets = () => Array.from({ length: this.targetCount(n) }, (_, i) => Math.fround(weights[i] ?? 0));
    const members = ['translation', 'rotation', 'scale', 'matrix', 'children', 'camera'].map((key) => [key, node[key]]), ofMesh = isShown && { skin: skin === undefined ? null : bind(), weights: ofTargets() };
    return { ...Object.fromEntries(members), ...ofMesh, mesh: isShown, visibility: extensions?.KHR_node_visibility };
  }
  channel(samplers, { sampler, target: { node, path, extensions } }) {  // what it is as a text, and its values, or texts of keys that may have others between
    const { input, output, interpolation = 'LINEAR' } = samplers?.[sampler] ?? {}, { values } = this.file.accessor(output), times = this.file.accessor(input).values;
    const [kept, all, own] = [this.source, this.torn, this.file].map((file) => this.targetCount(node, file)), isOpened = path === 'weights' && all > kept;
    const key = (k, first = (interpolation === 'CUBICSPLINE' ? 3 * k + 1 : k) * own) => values.slice(first, first + kept).map(Math.fround);
    return [JSON.stringify([node, path, extensions, interpolation, isOpened || this.valuesOf(input)]), isOpened ? Array.from(times, (time, k) => `${time} ${key(k)}`) : values];
  }
  clips() {  // their channels, but those of morph weights of meshes that are gone
    const isKept = ({ target }) => target && !(target.path === 'weights' && this.isGone(target.node)), clip = ({ channels = [], samplers }) => channels.filter(isKept).map((one) => this.channel(samplers, one));
    return (this.file.json.animations ?? []).map((one) => clip(one).sort(([a], [b]) => (a < b ? -1 : 1))).filter((all) => all.length > 0);
  }
}
function isSameChannel([is, from], [other, to]) {  // rotations of unit length may be rounded anew
  const isUnit = (x, i) => JSON.parse(is)[1] === 'rotation' && Math.abs(x / Math.hypot(...from.subarray(i & ~3, (i & ~3) + 4)) - to[i]) <= 4 * HALF_ULP, keys = new Set(Array.isArray(to) ? to : []);
  return is === other && (Array.isArray(from) ? from.every((key) => keys.has(key)) : from.length === to.length && from.every((x, i) => Math.fround(x) === Math.fround(to[i]) || isUnit(x, i)));
}
function checkDocument(before, after, say) {  // scenes, nodes, skins, clips and materials are those of the source
  const { materials = [] } = before.file.json, differ = (a, b) => JSON.stringify(a) !== JSON.stringify(b), text = 'differs from the source', [old, now] = [before.clips(), after.clips()];
  const scenes = ({ json }) => [json.scene, (json.scenes ?? []).map(({ nodes = [] }) => nodes)], parts = { nodes: ({ json }) => (json.nodes ?? []).length, scenes, materials: ({ json }) => (json.materials ?? []).slice(0, materials.length) };
  for (const [attribute, part] of Object.entries(parts)) if (differ(part(before.file), part(after.file))) say({ attribute, text });
  if (old.length !== now.length || !old.every((clip, c) => clip.length === now[c].length && clip.every((one, i) => isSameChannel(one, now[c][i])))) say({ attribute: 'animations', text });
  const differing = (was, is) => Object.keys({ ...was, ...is }).filter((key) => differ(was[key], is[key]));
  before.nodes.slice(0, after.nodes.length).forEach(({ name }, n) => differing(before.node(n), after.node(n)).forEach((attribute) => say({ node: n, name, attribute, text })));
}
/** Checks a torn file against its source. @return { faults: [{ mesh, primitive, vertex, attribute, text }], meshes: counts }. Throws Unchecked. */
export function checkTorn(source, torn) {
  const faults = [], groups = new Map(), root = torn.json.extensions?.[EXTENSION], gone = new Set(), say = (fault) => faults.length < MOST_FAULTS && faults.push(fault);
  const digest = source.once('digest', () => digestOf(source.bytes)), primitivesOf = (file, n) => (n === undefined ? [] : file.entry('meshes', n).primitives ?? []);
  need(root?.version === 1, `it has no record ${EXTENSION} of version 1`) ?? need(root.source?.sha256 === digest, `it was torn from another file: ${JSON.stringify(root.source)}`);
  for (const { node, primitives } of root.gone ?? []) primitives.forEach((p) => gone.add(`${node} ${p}`));
  const isGone = (n) => primitivesOf(source, source.json.nodes?.[n]?.mesh).every((_, p) => gone.has(`${n} ${p}`)), [before, after] = [source, torn].map((file) => new Shown(file, source, torn, isGone));
  checkDocument(before, after, say);
  before.nodes.slice(0, after.nodes.length).forEach((node, n) => {
    const { mesh: m, skin } = after.nodes[n], { name } = torn.json.meshes?.[m] ?? {}, rest = [], owned = [], targets = before.targetCount(n);
    primitivesOf(torn, m).forEach((primitive, p) => {
      const record = primitive.extensions?.[EXTENSION], key = JSON.stringify([n, m, primitive.attributes, primitive.targets, { ...record, indexSum: undefined, sourcePrimitive: undefined }]);
      if (!record || record.sourceMesh !== node.mesh) { rest.push([p, record ? '' : after.primitive(primitive, targets)]); return; }
      const options = { slots: skin === undefined ? 0 : torn.entry('skins', skin).joints.length, isCertified: root.certifiedBound !== undefined, placeBound: root.placeBound ?? Infinity };
      const sayOf = (vertex, attribute, text) => say({ mesh: m, name, primitive: p, vertex, attribute, text }), group = groups.get(key) ?? new TornMesh(source, torn, record, primitive, options, sayOf);
      if (group.primitives === 0) owned.push(...groups.set(key, group).get(key).record.sourcePrimitives);
      group.checkTriangles(primitive);
    });
    primitivesOf(source, node.mesh).forEach((primitive, p) => {  // each is torn, gone, or there as it was
      const times = owned.filter((one) => one === p).length + gone.has(`${n} ${p}`), found = times > 0 ? -1 : rest.findIndex(([, text]) => text === before.primitive(primitive, targets));
      if (found >= 0) rest.splice(found, 1); else if (times !== 1) say({ node: n, name: node.name, attribute: `primitive ${p} of mesh ${node.mesh}`, text: times > 1 ? 'is there twice' : 'is not there, or differs' });
    });
    rest.forEach(([p]) => say({ mesh: m, name, primitive: p, vertex: null, attribute: 'record', text: 'is missing or of another mesh, but it differs from the source' }));
  });
  groups.forEach((group) => group.checkCover());
  return { faults, meshes: [...groups].map(([key, { counts }]) => ({ mesh: JSON.parse(key)[1], ...counts })), certifiedBound: root.certifiedBound, placeBound: root.placeBound };
}
export function openGltf(file) {
  try { return new Gltf(readFileSync(file), dirname(resolve(file))); } catch ({ message }) { throw new Unchecked(`${file}: ${message}`); }
}
function main(args) {
  const files = args.filter((arg) => arg !== '--json'), ofMesh = ({ mesh, name = '', primitive, vertex }) => `mesh ${mesh} '${name}', primitive ${primitive}${vertex === null ? '' : `, vertex ${vertex}`}`;
  const placeOf = (fault) => (fault.node !== undefined ? `node ${fault.node} '${fault.name ?? ''}'` : fault.mesh !== undefined ? ofMesh(fault) : 'document');
  const result = need(files.length === 2, 'usage: node check_torn.mjs SOURCE.glb TORN.glb [--json]') ?? checkTorn(openGltf(files[0]), openGltf(files[1])), { faults, meshes } = result, end = faults.length === 0 ? 'proved' : `wrong: ${faults.length}${faults.length < MOST_FAULTS ? '' : ' or more'}`;
  const lines = meshes.map(({ mesh, ...counts }) => `mesh ${mesh}: ${Object.entries(counts).map((count) => count.join(' ')).join(', ')}`), texts = faults.map((fault) => `${placeOf(fault)}: ${fault.attribute}: ${fault.text}`);
  return console.log(files.length < args.length ? JSON.stringify(result) : [...lines, ...texts, end].join('\n')) ?? (faults.length === 0 ? 0 : 1);
}
if (process.argv[1]?.endsWith('check_torn.mjs'))
  try { process.exitCode = main(process.argv.slice(2)); } catch (error) { process.exitCode = (console.error(`check_torn: ${error.message}`), 2); }
