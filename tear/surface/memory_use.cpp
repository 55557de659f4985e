#include "tear/surface/memory_use.h"

namespace sunder::tear {

void MemoryUse::add(const Mesh& mesh) {
  add(mesh.positions);
  add(mesh.normals);
  add(mesh.tangents);
  add(mesh.uv_sets);
  for (const auto& uv : mesh.uv_sets) add(uv);
  add(mesh.color_sets);
  for (const auto& colors : mesh.color_sets) add(colors);
  add(mesh.custom_attributes);
  for (const CustomAttribute& attribute : mesh.custom_attributes) add(attribute.values);
  add(mesh.weights.first);
  add(mesh.weights.influences);
  add(mesh.morph_targets);
  for (const MorphTarget& target : mesh.morph_targets) {
    add(target.position_deltas);
    add(target.normal_deltas);
    add(target.tangent_deltas);
  }
  add(mesh.triangles);
  add(mesh.triangle_submesh);
  add(mesh.submeshes);
}

void MemoryUse::add(const Character& character) {
  add(character.meshes);
  for (const Mesh& mesh : character.meshes) add(mesh);
  add(character.skeleton.bones);
  add(character.skins);
  for (const Skin& skin : character.skins) {
    add(skin.bones);
    add(skin.bone_from_bind);
  }
  add(character.rest_morph_weights);
  add(character.clips);
  for (const Clip& clip : character.clips) {
    add(clip.channels);
    for (const Channel& channel : clip.channels) {
      add(channel.times);
      add(channel.values);
    }
  }
}

void MemoryUse::add(const Surface& surface) {
  add(surface.corner_point);
  add(surface.twin);
  add(surface.first_triangle);
  add(surface.appended);
  add(surface.point_corner);
  add(surface.source_side);
  add(surface.appended_side);
  add(surface.cracks);
  for (const auto& is_shared : surface.is_shared_vertex) add(is_shared);
}

void MemoryUse::add(const EditColumns& columns) {
  add(columns.surface);
  add(columns.meshes);
  for (const MeshColumns& mesh : columns.meshes) {
    add(mesh.births);
    add(mesh.records);
    add(mesh.surface_triangles);
    add(mesh.fillings);
    add(mesh.filling_groups);
    add(mesh.filling_serials);
    add(mesh.newest_part);
    add(mesh.spare_sides);
  }
  add(columns.vertex_mesh);
  add(columns.parents);
  add(columns.older_part);
  add(columns.newest_change);
  add(columns.ancestors);
  add(columns.kept_births);
  add(columns.kept_influences);
  add(columns.additions);
  add(columns.triangle_changes);
  add(columns.side_changes);
  add(columns.scars);
  add(columns.threads);
}

}  // namespace sunder::tear
