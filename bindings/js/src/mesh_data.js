// A mesh with all attributes. Its arrays are views on the memory of the library, made at each reading.
import { sunder_attribute, sunder_submesh } from '../generated/calls.js';

export class MeshData {
  #memory;
  #check;
  #mesh;

  /** @param check  throws when the arrays are not valid any more */
  constructor(memory, mesh, check) {
    this.#memory = memory;
    this.#mesh = mesh;
    this.#check = check;
    this.name = memory.text(mesh.name);
    this.vertexCount = mesh.vertex_count;
    this.triangleCount = mesh.triangle_count;
    this.submeshes = memory.readStructs(sunder_submesh, mesh.submeshes, mesh.submesh_count).map((submesh) => ({
      name: memory.text(submesh.name), material: submesh.material === 0xFFFFFFFF ? null : submesh.material }));
  }

  #array(Type, at, length) {
    this.#check();
    return at ? this.#memory.viewOf(Type, at, length) : null;
  }
  #table(at, count, perVertex) {
    this.#check();
    return Array.from({ length: count }, (_, i) => this.#array(Float32Array, this.#memory.u32(at + 4 * i), perVertex * this.vertexCount));
  }

  /** The skin of the model on whose slots the influences are. */
  get skin() { return this.#mesh.skin; }
  get positions() { return this.#array(Float32Array, this.#mesh.positions, 3 * this.vertexCount); }
  get normals() { return this.#array(Float32Array, this.#mesh.normals, 3 * this.vertexCount); }
  get tangents() { return this.#array(Float32Array, this.#mesh.tangents, 4 * this.vertexCount); }
  /** Each 2 numbers per vertex. */
  get uvSets() { return this.#table(this.#mesh.uv_sets, this.#mesh.uv_set_count, 2); }
  /** Each 4 numbers per vertex, linear. */
  get colorSets() { return this.#table(this.#mesh.color_sets, this.#mesh.color_set_count, 4); }
  get attributes() {
    this.#check();
    return this.#memory.readStructs(sunder_attribute, this.#mesh.attributes, this.#mesh.attribute_count).map((one) => ({
      name: this.#memory.text(one.name), components: one.components, isLabel: one.is_label !== 0,
      values: this.#array(Float32Array, one.values, one.components * this.vertexCount) }));
  }
  /** 3 per triangle; one vertex three times: it was removed. */
  get triangles() { return this.#array(Uint32Array, this.#mesh.triangles, 3 * this.triangleCount); }
  get triangleSubmesh() { return this.#array(Uint32Array, this.#mesh.triangle_submesh, this.triangleCount); }
  get firstInfluence() { return this.#array(Uint32Array, this.#mesh.first_influence, this.vertexCount + 1); }
  /** Pairs of a slot and, in the same four bytes as a float, a weight: `new Float32Array(x.buffer, x.byteOffset, x.length)`. */
  get influences() {
    const first = this.firstInfluence;
    return first && this.#array(Uint32Array, this.#mesh.influences, 2 * first[this.vertexCount]);
  }
}
