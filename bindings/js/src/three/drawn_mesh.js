// One mesh of an instance as a mesh of three.js: buffers that have room to grow, and only changed ranges are uploaded.
import { Box3, BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh, Sphere } from 'three';

/** How much larger than needed buffers are made, so that the next tears fit. */
const ROOM = 1.5;
/** Ranges closer than this are uploaded as one: a call costs more than some vertices. */
const GAP = 32;

/** Ascending ranges with small gaps closed. */
function merged(ranges) {
  const wide = [];
  for (const { first, count } of ranges) {
    const last = wide[wide.length - 1];
    if (last && first <= last.first + last.count + GAP && first >= last.first) last.count = Math.max(last.count, first + count - last.first);
    else wide.push({ first, count });
  }
  return wide;
}

export class DrawnMesh extends Mesh {
  #instance;
  #index;
  #materialOf;
  #vertices = 0;
  #triangles = 0;
  #seen = 0n;
  #draws = '';

  /** @param materialOf  the material of a submesh, { name, material }, and whether it is flesh inside */
  constructor(instance, index, materialOf) {
    super(new BufferGeometry(), []);
    this.#instance = instance;
    this.#index = index;
    this.#materialOf = materialOf;
    this.name = instance.model.mesh(index).name;
    this.matrixAutoUpdate = false;
  }

  /** Draws another instance of the same character from the next update() on. */
  set instance(instance) {
    this.#instance = instance;
    this.#seen = 0n;
    this.#draws = '';
  }

  /** Copies what changed since the last call. @returns the bytes that will be uploaded */
  update() {
    let posed = this.#instance.mesh(this.#index, this.#seen), attributes = posed.dirtyAttributes;
    if (posed.vertexCount > this.#vertices || posed.triangleCapacity > this.#triangles) {
      this.#grow(posed);
      this.#seen = 0n;
      posed = this.#instance.mesh(this.#index, this.#seen);
    }
    if (this.#seen === 0n) attributes = [{ first: 0, count: posed.vertexCount }];
    const bytes = this.#copyVertices(posed) + this.#copyAttributes(attributes) + this.#copyTriangles(posed);
    this.#setGroups(posed);
    this.#seen = posed.epoch;
    return bytes;
  }

  /** three's buffers cannot grow: a new geometry replaces the old one. */
  #grow(posed) {
    const source = this.#instance.source(this.#index);
    const room = (needed, had) => (needed > had ? Math.ceil(needed * ROOM) : had);
    this.#vertices = room(posed.vertexCount, this.#vertices);
    this.#triangles = room(posed.triangleCapacity, this.#triangles);
    const geometry = new BufferGeometry();
    const add = (name, components, isDynamic) => {
      const attribute = new BufferAttribute(new Float32Array(components * this.#vertices), components);
      geometry.setAttribute(name, isDynamic ? attribute.setUsage(DynamicDrawUsage) : attribute);
    };
    add('position', 3, true);
    if (posed.normals) add('normal', 3, true);
    if (posed.tangents) add('tangent', 4, true);
    source.uvSets.forEach((_, i) => add(i === 0 ? 'uv' : `uv${i}`, 2, false));
    if (source.colorSets.length) add('color', 4, false);
    geometry.setIndex(new BufferAttribute(new Uint32Array(3 * this.#triangles), 1));
    geometry.boundingBox = new Box3();
    geometry.boundingSphere = new Sphere();
    this.geometry.dispose();
    this.geometry = geometry;
    this.#draws = '';
  }

  #copyVertices(posed) {
    const ranges = merged(posed.dirtyVertices), { attributes } = this.geometry;
    if (ranges.length === 0) return 0;
    let bytes = copy(attributes.position, posed.positions, ranges);
    if (attributes.normal) bytes += copy(attributes.normal, posed.normals, ranges);
    if (attributes.tangent) bytes += copy(attributes.tangent, posed.tangents, ranges);
    this.#setBounds(posed.vertexCount);
    return bytes;
  }

  #copyAttributes(dirty) {
    const ranges = merged(dirty), { attributes } = this.geometry;
    if (ranges.length === 0) return 0;
    const source = this.#instance.source(this.#index);
    let bytes = 0;
    source.uvSets.forEach((values, i) => { bytes += copy(attributes[i === 0 ? 'uv' : `uv${i}`], values, ranges); });
    if (attributes.color) bytes += copy(attributes.color, source.colorSets[0], ranges);
    return bytes;
  }

  #copyTriangles(posed) {
    const { index } = this.geometry, initial = posed.initialTriangles, writes = posed.triangleWrites;
    if (initial.length === 0 && writes.length === 0) return 0;
    const ranges = [];
    if (initial.length) {
      index.array.fill(0);  // triangles that no range draws
      index.array.set(initial);
      ranges.push({ first: 0, count: this.#triangles });
    }
    for (let i = 0; i < writes.length; i += 4) {
      index.array.set(writes.subarray(i + 1, i + 4), 3 * writes[i]);
      if (!initial.length) ranges.push({ first: writes[i], count: 1 });
    }
    ranges.sort((a, b) => a.first - b.first);
    return mark(index, merged(ranges), 3);
  }

  #setGroups(posed) {
    const draws = posed.drawRanges, key = draws.map((range) => Object.values(range).join()).join(';');
    if (key === this.#draws) return;
    this.#draws = key;
    this.geometry.clearGroups();
    for (const { submesh, firstTriangle, triangleCount } of draws) this.geometry.addGroup(3 * firstTriangle, 3 * triangleCount, submesh);
    const before = this.#instance.model.mesh(this.#index).submeshes.length;
    this.material = this.#instance.source(this.#index).submeshes.map((submesh, i) => this.#materialOf(submesh, i >= before));
  }

  #setBounds(vertexCount) {
    const { boundingBox: box, boundingSphere: sphere, attributes } = this.geometry, { array } = attributes.position;
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < 3 * vertexCount; i += 3) {
      for (let k = 0; k < 3; ++k) {
        const value = array[i + k];
        if (value < low[k]) low[k] = value;
        if (value > high[k]) high[k] = value;
      }
    }
    box.min.fromArray(low);
    box.max.fromArray(high);
    box.getCenter(sphere.center);
    let squared = 0;
    const { x, y, z } = sphere.center;
    for (let i = 0; i < 3 * vertexCount; i += 3)
      squared = Math.max(squared, (array[i] - x) ** 2 + (array[i + 1] - y) ** 2 + (array[i + 2] - z) ** 2);
    sphere.radius = Math.sqrt(squared);
  }
}

function copy(attribute, from, ranges) {
  const size = attribute.itemSize;
  for (const { first, count } of ranges) attribute.array.set(from.subarray(size * first, size * (first + count)), size * first);
  return mark(attribute, ranges, size);
}

/** The renderer forgets ranges when it has uploaded them; those of frames that were not drawn stay. */
function mark(attribute, ranges, size) {
  let bytes = 0;
  for (const { first, count } of ranges) {
    attribute.addUpdateRange(size * first, size * count);
    bytes += 4 * size * count;
  }
  attribute.needsUpdate = true;
  return bytes;
}
