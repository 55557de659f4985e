// A mesh of an instance as the last update posed it, and what changed in it. Its arrays are views, made at each reading.
import { sunder_draw_range, sunder_range } from '../generated/calls.js';

export class PosedMesh {
  #memory;
  #check;
  #posed;

  /** @param check  throws when the arrays are not valid any more */
  constructor(memory, posed, check) {
    this.#memory = memory;
    this.#posed = posed;
    this.#check = check;
    this.vertexCount = posed.vertex_count;
    this.triangleCapacity = posed.triangle_capacity;
    /** To be passed as `seen` next time. */
    this.epoch = posed.epoch;
  }

  #array(Type, at, length) {
    this.#check();
    return at ? this.#memory.viewOf(Type, at, length) : null;
  }
  #ranges(at, count) {
    this.#check();
    return this.#memory.readStructs(sunder_range, at, count);
  }

  get positions() { return this.#array(Float32Array, this.#posed.positions, 3 * this.vertexCount); }
  get normals() { return this.#array(Float32Array, this.#posed.normals, 3 * this.vertexCount); }
  get tangents() { return this.#array(Float32Array, this.#posed.tangents, 4 * this.vertexCount); }
  /** One draw call each: { submesh, firstTriangle, triangleCount }. */
  get drawRanges() {
    this.#check();
    return this.#memory.readStructs(sunder_draw_range, this.#posed.ranges, this.#posed.range_count).map((range) => ({
      submesh: range.submesh, firstTriangle: range.first_triangle, triangleCount: range.triangle_count }));
  }
  get dirtyVertices() { return this.#ranges(this.#posed.dirty_vertices, this.#posed.dirty_vertex_count); }
  get dirtyAttributes() { return this.#ranges(this.#posed.dirty_attributes, this.#posed.dirty_attribute_count); }
  /** Not empty: the index buffer starts anew with these. */
  get initialTriangles() {
    return this.#array(Uint32Array, this.#posed.initial_triangles, 3 * this.#posed.initial_triangle_count) ?? new Uint32Array(0);
  }
  /** Four numbers each, in order: the place in triangles, and its vertices. */
  get triangleWrites() {
    return this.#array(Uint32Array, this.#posed.triangle_writes, 4 * this.#posed.triangle_write_count) ?? new Uint32Array(0);
  }
}
