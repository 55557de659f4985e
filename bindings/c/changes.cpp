// What the commands of the last update changed, for copies of models that a program keeps.

#include "bindings/c/numbers.h"
#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

static_assert(sizeof(RewrittenTriangle) == sizeof(sunder_triangle_write));
static_assert(sizeof(LipPair) == 2 * sizeof(std::uint32_t));
static_assert(sizeof(WeldedPoint) == 2 * sizeof(std::uint32_t));

/// Finds the changes of a command of the last update.
sunder_status find_changes(sunder_scene scene, sunder_command command,
                           const std::vector<ChangeRecord>*& changes) {
  const SceneObject* const object = find<SceneObject>(scene);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  if (!object->wants_changes)
    return fail(SUNDER_NOT_FOUND, kNone,
                "the scene keeps no changes: set `wants_changes` in sunder_scene_options");
  for (const CommandResult& result : object->scene.results()) {
    if (result.command != command) continue;
    changes = &result.changes;
    return SUNDER_OK;
  }
  return fail(SUNDER_NOT_FOUND, kNone, "the last update has no result of command %llu",
              static_cast<unsigned long long>(command));
}

sunder_status find_change(sunder_scene scene, sunder_command command, std::uint32_t which,
                          const ChangeRecord*& change) {
  const std::vector<ChangeRecord>* changes = nullptr;
  SUNDER_C_TRY(find_changes(scene, command, changes));
  if (which >= changes->size())
    return fail(SUNDER_INDEX_OUT_OF_RANGE, which, "change %u of %zu", which, changes->size());
  change = &(*changes)[which];
  return SUNDER_OK;
}

const std::uint32_t* view_of(const std::vector<std::uint32_t>& numbers) {
  return numbers.empty() ? nullptr : numbers.data();
}

sunder_change view_of(const ChangeRecord& from) {
  sunder_change to = {};
  to.struct_size = sizeof to;
  to.first_point = from.first_point;
  to.point_count = from.point_count;
  to.mesh_count = count_of(from.meshes);
  to.lip_count = count_of(from.lips);
  to.left_count = count_of(from.rims.left);
  to.right_count = count_of(from.rims.right);
  to.weld_count = count_of(from.welded);
  to.lips = from.lips.empty() ? nullptr : &from.lips.front().left;
  to.left = view_of(from.rims.left);
  to.right = view_of(from.rims.right);
  to.welds = from.welded.empty() ? nullptr : &from.welded.front().kept;
  return to;
}

sunder_mesh_change view_of(const MeshChange& from) {
  sunder_mesh_change to = {};
  to.struct_size = sizeof to;
  to.mesh = from.mesh;
  to.first_vertex = from.first_vertex;
  to.vertex_count = from.vertex_count;
  to.first_triangle = from.first_triangle;
  to.triangle_count = from.triangle_count;
  to.rewritten_count = count_of(from.rewritten);
  to.retired_count = count_of(from.retired);
  to.released_count = count_of(from.released);
  to.returned_count = count_of(from.returned);
  to.dirty_vertex_count = count_of(from.dirty_vertices);
  to.dirty_triangle_count = count_of(from.dirty_triangles);
  to.rewritten = reinterpret_cast<const sunder_triangle_write*>(from.rewritten.data());
  to.retired = view_of(from.retired);
  to.released = view_of(from.released);
  to.returned = view_of(from.returned);
  to.dirty_vertices = reinterpret_cast<const sunder_range*>(from.dirty_vertices.begin());
  to.dirty_triangles = reinterpret_cast<const sunder_range*>(from.dirty_triangles.begin());
  return to;
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_status sunder_get_change_count(sunder_scene scene, sunder_command command, uint32_t* count) {
  return guarded([&]() -> sunder_status {
    const std::vector<sunder::ChangeRecord>* changes = nullptr;
    SUNDER_C_TRY(find_changes(scene, command, changes));
    if (count == nullptr) return null_pointer("count");
    *count = count_of(*changes);
    return SUNDER_OK;
  });
}

sunder_status sunder_get_change(sunder_scene scene, sunder_command command, uint32_t which,
                                sunder_change* change) {
  return guarded([&]() -> sunder_status {
    const sunder::ChangeRecord* found = nullptr;
    SUNDER_C_TRY(find_change(scene, command, which, found));
    SUNDER_C_TRY(check_struct(change, "change"));
    *change = view_of(*found);
    return SUNDER_OK;
  });
}

sunder_status sunder_get_mesh_change(sunder_scene scene, sunder_command command, uint32_t which,
                                     uint32_t part, sunder_mesh_change* change) {
  return guarded([&]() -> sunder_status {
    const sunder::ChangeRecord* found = nullptr;
    SUNDER_C_TRY(find_change(scene, command, which, found));
    SUNDER_C_TRY(check_struct(change, "change"));
    if (part >= found->meshes.size())
      return fail(SUNDER_INDEX_OUT_OF_RANGE, part, "mesh %u of %zu that changed", part,
                  found->meshes.size());
    *change = view_of(found->meshes[part]);
    return SUNDER_OK;
  });
}

}  // extern "C"
