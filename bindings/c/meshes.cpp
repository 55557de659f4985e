// Meshes of an instance: posed for drawing, and in bind space with all attributes.

#include <sunder/tear/torn_weights.h>

#include <utility>

#include "bindings/c/bytes.h"
#include "bindings/c/numbers.h"
#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

static_assert(sizeof(IndexRange) == sizeof(sunder_range));
static_assert(sizeof(TriangleWrite) == sizeof(sunder_triangle_write));

sunder_posed_mesh view_of(const PosedMesh& mesh) {
  sunder_posed_mesh view = {};
  view.struct_size = sizeof view;
  view.vertex_count = count_of(mesh.positions);
  view.triangle_capacity = mesh.triangle_capacity;
  view.range_count = count_of(mesh.ranges);
  view.dirty_vertex_count = count_of(mesh.dirty_vertices);
  view.dirty_attribute_count = count_of(mesh.dirty_attributes);
  view.triangle_write_count = count_of(mesh.triangle_writes);
  view.initial_triangle_count = count_of(mesh.initial_triangles);
  view.epoch = mesh.epoch;
  view.positions = numbers_of(mesh.positions);
  view.normals = numbers_of(mesh.normals);
  view.tangents = numbers_of(mesh.tangents);
  view.ranges = reinterpret_cast<const sunder_draw_range*>(mesh.ranges.data());
  view.dirty_vertices = reinterpret_cast<const sunder_range*>(mesh.dirty_vertices.data());
  view.dirty_attributes = reinterpret_cast<const sunder_range*>(mesh.dirty_attributes.data());
  view.triangle_writes =
      reinterpret_cast<const sunder_triangle_write*>(mesh.triangle_writes.data());
  view.initial_triangles = numbers_of(mesh.initial_triangles);
  return view;
}

VertexTarget target_of(const sunder_vertex_target& from) {
  VertexTarget target;
  target.vertex_count = from.vertex_count;
  target.positions = {from.positions, from.position_stride};
  target.normals = {from.normals, from.normal_stride};
  target.tangents = {from.tangents, from.tangent_stride};
  target.unit_length = from.unit_length != 0;
  return target;
}

/// The parts of the asset of an instance; null for one that the scene does not know.
const AssetParts* parts_of(const Found& found) {
  for (const auto& parts : found.scene->assets)
    if (parts->asset == found.instance->asset()) return parts.get();
  return nullptr;
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_vertex_target sunder_default_vertex_target(void) {
  sunder_vertex_target target = {};
  target.struct_size = sizeof target;
  return target;
}

sunder_status sunder_get_posed_mesh(sunder_scene scene, sunder_instance instance, uint32_t mesh,
                                    uint64_t seen, sunder_posed_mesh* posed) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_mesh(scene, instance, mesh, found));
    SUNDER_C_TRY(check_struct(posed, "posed"));
    *posed = view_of(found.scene->scene.mesh(instance_of(instance), mesh, seen));
    return SUNDER_OK;
  });
}

sunder_status sunder_set_vertex_target(sunder_scene scene, sunder_instance instance, uint32_t mesh,
                                       const sunder_vertex_target* target) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_mesh(scene, instance, mesh, found));
    SUNDER_C_TRY(check_struct(target, "target"));
    ++found.scene->change;
    return report(found.instance->set_target(mesh, target_of(*target)));
  });
}

sunder_status sunder_get_instance_mesh(sunder_scene scene, sunder_instance instance, uint32_t mesh,
                                       sunder_mesh* view) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_mesh(scene, instance, mesh, found));
    if (view == nullptr) return null_pointer("view");
    found.scene->mesh_view.set(found.instance->character().meshes[mesh]);
    *view = found.scene->mesh_view.get();
    return SUNDER_OK;
  });
}

sunder_status sunder_save_instance(sunder_scene scene, sunder_instance instance,
                                   const sunder_save_options* options, sunder_bytes* glb) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    SUNDER_C_TRY(check_options(options, "options"));
    if (glb == nullptr) return null_pointer("glb");
    const AssetParts* const parts = parts_of(found);
    const bool has_source = parts != nullptr && parts->character->loaded.source != nullptr;
    sunder::SaveOptions save = save_options_of(options);
    const sunder::TornModel* const model = found.instance->model();
    const sunder::Character* torn = &found.instance->character();
    sunder::Character scarred;
    if (model != nullptr && !sunder::scars_of(*model).empty()) {
      scarred = *torn;
      sunder::mark_scars(*model, scarred);
      torn = &scarred;
    }
    if (has_source && model != nullptr &&
        &model->source() == parts->character->loaded.character.get()) {
      auto origins = sunder::vertex_origins(*model);
      if (!origins) return report(origins.error());
      save.origins = std::move(*origins);
    }
    auto bytes = has_source ? parts->character->save(*torn, save) : sunder::save_glb(*torn, save);
    if (!bytes) return report(bytes.error());
    return add_bytes(std::move(*bytes), glb);
  });
}

}  // extern "C"
