// A character from arrays, as sunder_create_character() wants it.
import { invalidArgument } from './sunder_error.js';

const NONE = 0xFFFFFFFF;
const IDENTITY = Float32Array.of(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0);

const transformOf = ({ translation = [0, 0, 0], rotation = [0, 0, 0, 1], scale = [1, 1, 1] } = {}) => ({ translation, rotation, scale });

const boneOf = (bone, i) => ({ name: bone.name ?? `bone ${i}`, parent: bone.parent ?? NONE, rest: transformOf(bone) });

function skinOf(skin) {
  const bones = Uint32Array.from(skin.bones);
  if (skin.boneFromBind?.length !== 12 * bones.length) throw invalidArgument('boneFromBind: 12 numbers per bone of a skin are expected');
  return { name: skin.name ?? '', bones, bone_from_bind: Float32Array.from(skin.boneFromBind), slot_count: bones.length };
}

/** Influences: per vertex `influences` slots and as many weights; zeros are left out. */
function influencesOf({ slots, weights, vertexCount }) {
  if (!slots) {
    return { first: Uint32Array.from({ length: vertexCount + 1 }, (_, v) => v), list: Array.from({ length: vertexCount }, () => ({ slot: 0, weight: 1 })) };
  }
  const per = slots.length / vertexCount;
  if (!Number.isInteger(per) || weights?.length !== slots.length) throw invalidArgument('slots and weights: the same number per vertex is expected');
  const first = new Uint32Array(vertexCount + 1), list = [];
  for (let v = 0; v < vertexCount; ++v) {
    for (let i = v * per; i < (v + 1) * per; ++i) if (weights[i] > 0) list.push({ slot: slots[i], weight: weights[i] });
    first[v + 1] = list.length;
  }
  return { first, list };
}

function meshOf(mesh) {
  const positions = Float32Array.from(mesh.positions);
  const vertexCount = positions.length / 3;
  if (!Number.isInteger(vertexCount)) throw invalidArgument('positions: three numbers per vertex are expected');
  const triangles = Uint32Array.from(mesh.triangles ?? { length: vertexCount }, (v, i) => v ?? i);
  if (triangles.length % 3 !== 0) throw invalidArgument('triangles: three numbers each are expected');
  const uvSets = mesh.uvSets ?? (mesh.uvs ? [mesh.uvs] : []);
  const { first, list } = influencesOf({ ...mesh, vertexCount });
  return {
    name: mesh.name ?? '', positions, normals: mesh.normals ? Float32Array.from(mesh.normals) : 0, tangents: 0,
    uv_sets: uvSets.length ? uvSets.map((uvs) => Float32Array.from(uvs)) : 0, uv_set_count: uvSets.length,
    first_influence: first, influences: list, triangles,
    triangle_submesh: mesh.triangleSubmesh ? Uint32Array.from(mesh.triangleSubmesh) : new Uint32Array(triangles.length / 3),
    submeshes: (mesh.submeshes ?? [{}]).map((one) => ({ name: one.name ?? '', material: one.material ?? NONE })),
    submesh_count: mesh.submeshes?.length ?? 1, skin: mesh.skin ?? 0, vertex_count: vertexCount, triangle_count: triangles.length / 3,
  };
}

/** `{ name, bones, skins, meshes }`; without bones, one that does not move and carries everything. */
export function characterData(data) {
  const meshes = (data.meshes ?? [data]).map(meshOf);
  const bones = (data.bones ?? [{ name: 'root' }]).map(boneOf);
  const skins = (data.skins ?? [{ bones: [0], boneFromBind: IDENTITY }]).map(skinOf);
  return { name: data.name ?? '', bones, bone_count: bones.length, skins, skin_count: skins.length, meshes, mesh_count: meshes.length };
}
