#include "tear/surface/compact.h"

#include <sunder/tear/torn_model.h>

namespace sunder {
namespace {

struct MeshMaps {
  CompactMaps::OfMesh old_from_new;
  std::vector<Index> vertex_new_from_old;  ///< kNone for vertices that are removed.
};

MeshMaps find_kept(const Mesh& mesh) {
  MeshMaps maps;
  maps.vertex_new_from_old.assign(mesh.vertex_count(), kNone);
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    if (is_retired(mesh.triangles[t])) continue;
    maps.old_from_new.triangle_old_from_new.push_back(t);
    for (const Index vertex : mesh.triangles[t]) maps.vertex_new_from_old[vertex] = 0;
  }
  auto& vertices = maps.old_from_new.vertex_old_from_new;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (maps.vertex_new_from_old[v] == kNone) continue;
    maps.vertex_new_from_old[v] = static_cast<Index>(vertices.size());
    vertices.push_back(v);
  }
  return maps;
}

/// In place: the maps ascend, so nothing is overwritten before it is read.
template <class Value>
void keep(const std::vector<Index>& old_from_new, std::vector<Value>& values,
          std::size_t per_element = 1) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < old_from_new.size(); ++i)
    for (std::size_t c = 0; c < per_element; ++c)
      values[i * per_element + c] = values[old_from_new[i] * per_element + c];
  values.resize(old_from_new.size() * per_element);
}

void keep_weights(const std::vector<Index>& old_from_new, SkinWeights& weights) {
  Index end = 0;
  for (std::size_t i = 0; i < old_from_new.size(); ++i) {
    const Index from = weights.first[old_from_new[i]], to = weights.first[old_from_new[i] + 1];
    weights.first[i] = end;
    for (Index k = from; k < to; ++k) weights.influences[end++] = weights.influences[k];
  }
  weights.first[old_from_new.size()] = end;
  weights.first.resize(old_from_new.size() + 1);
  weights.influences.resize(end);
}

void keep_vertices(const std::vector<Index>& old_from_new, Mesh& mesh) {
  keep(old_from_new, mesh.positions);
  keep(old_from_new, mesh.normals);
  keep(old_from_new, mesh.tangents);
  for (auto& uv : mesh.uv_sets) keep(old_from_new, uv);
  for (auto& colors : mesh.color_sets) keep(old_from_new, colors);
  for (CustomAttribute& attribute : mesh.custom_attributes)
    keep(old_from_new, attribute.values, attribute.components);
  for (MorphTarget& target : mesh.morph_targets) {
    keep(old_from_new, target.position_deltas);
    keep(old_from_new, target.normal_deltas);
    keep(old_from_new, target.tangent_deltas);
  }
  keep_weights(old_from_new, mesh.weights);
}

void apply(const MeshMaps& maps, Mesh& mesh) {
  keep_vertices(maps.old_from_new.vertex_old_from_new, mesh);
  keep(maps.old_from_new.triangle_old_from_new, mesh.triangles);
  keep(maps.old_from_new.triangle_old_from_new, mesh.triangle_submesh);
  for (Triangle& triangle : mesh.triangles)
    for (Index& vertex : triangle) vertex = maps.vertex_new_from_old[vertex];
}

}  // namespace

CompactMaps compact(Character& character) {
  // The maps are made first. Nothing after them allocates, so a character is never left half
  // changed.
  std::vector<MeshMaps> maps;
  CompactMaps result;
  maps.reserve(character.meshes.size());
  result.meshes.reserve(character.meshes.size());
  for (const Mesh& mesh : character.meshes) maps.push_back(find_kept(mesh));
  for (std::size_t m = 0; m < maps.size(); ++m) {
    apply(maps[m], character.meshes[m]);
    result.meshes.push_back(std::move(maps[m].old_from_new));
  }
  return result;
}

}  // namespace sunder
