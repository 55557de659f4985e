#include "bindings/c/piece.h"

#include <sunder/tear/detached_piece.h>

#include <algorithm>
#include <utility>

#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

using namespace sunder::c;

extern "C" {

sunder_status sunder_destroy_piece(sunder_piece piece) {
  return destroy_object(piece, Kind::piece);
}

sunder_status sunder_get_piece(sunder_piece piece, sunder_piece_info* info) {
  const PieceObject* const object = find<PieceObject>(piece);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  SUNDER_C_TRY(check_struct(info, "info"));
  const sunder::DetachedPiece& from = *object->piece;
  sunder_piece_info to = {};
  to.struct_size = sizeof to;
  to.solid = static_cast<uint32_t>(from.mass.rule);
  to.holes = from.mass.holes;
  to.mesh_count = static_cast<uint32_t>(from.meshes.size());
  std::copy_n(from.model_from_piece.data(), 12, to.model_from_piece);
  std::copy_n(from.mass.centre.data(), 3, to.centre);
  std::copy_n(from.mass.inertia.data(), 9, to.inertia);
  std::copy_n(from.inertia_piece.data(), 9, to.inertia_piece);
  to.mass = from.mass.mass;
  to.volume = from.mass.volume;
  to.area = from.mass.area;
  *info = to;
  return SUNDER_OK;
}

sunder_status sunder_get_piece_character(sunder_piece piece, sunder_character* character) {
  return guarded([&]() -> sunder_status {
    const PieceObject* const object = find<PieceObject>(piece);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (character == nullptr) return null_pointer("character");
    if (object->piece->character == nullptr)
      return fail(SUNDER_NOT_FOUND, sunder::kNone, "the piece vanished: it has no character");
    sunder::LoadedCharacter loaded;
    loaded.character = object->piece->character;
    return add_character(std::move(loaded), character);
  });
}

sunder_status sunder_get_piece_vertices(sunder_piece piece, uint32_t mesh, uint32_t* torn_mesh,
                                        const uint32_t** torn_vertices, uint32_t* count) {
  const PieceObject* const object = find<PieceObject>(piece);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  if (torn_mesh == nullptr) return null_pointer("torn_mesh");
  if (torn_vertices == nullptr) return null_pointer("torn_vertices");
  if (count == nullptr) return null_pointer("count");
  const auto& meshes = object->piece->meshes;
  if (mesh >= meshes.size())
    return fail(SUNDER_INDEX_OUT_OF_RANGE, mesh, "mesh %u of %zu", mesh, meshes.size());
  *torn_mesh = meshes[mesh].mesh;
  *torn_vertices = meshes[mesh].vertex_old_from_new.data();
  *count = static_cast<uint32_t>(meshes[mesh].vertex_old_from_new.size());
  return SUNDER_OK;
}

sunder_status sunder_get_piece_hulls(sunder_piece piece, uint32_t most_hulls, uint32_t most_points,
                                     const sunder_hull** hulls, uint32_t* count) {
  return guarded([&]() -> sunder_status {
    PieceObject* const object = find<PieceObject>(piece);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (hulls == nullptr) return null_pointer("hulls");
    if (count == nullptr) return null_pointer("count");
    auto found = sunder::convex_hulls(*object->piece, sunder::HullOptions{most_hulls, most_points});
    if (!found) return report(found.error());
    object->hulls.set(*std::move(found));
    object->hulls.get(hulls, count);
    return SUNDER_OK;
  });
}

sunder_status sunder_inherit_motion(sunder_scene scene, sunder_instance instance,
                                    sunder_piece piece) {
  return guarded([&]() -> sunder_status {
    const PieceObject* const object = find<PieceObject>(piece);
    Found found;
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    if (object->tissue == nullptr)
      return fail(SUNDER_INVALID_ARGUMENT, sunder::kNone, "the piece came off without soft tissue");
    ++found.scene->change;
    return report(found.instance->inherit_motion(*object->piece, *object->tissue));
  });
}

}  // extern "C"
