#pragma once

#include <sunder/core/mesh.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace sunder::test {

/// Appends a copy of a vertex.
inline std::uint32_t append_copy(Mesh& mesh, std::uint32_t vertex) {
  const auto copy = [&](auto& stream) {
    if (!stream.empty())
      stream.push_back(typename std::decay_t<decltype(stream)>::value_type(stream[vertex]));
  };
  copy(mesh.positions);
  copy(mesh.normals);
  copy(mesh.tangents);
  for (auto& uvs : mesh.uv_sets) copy(uvs);
  for (auto& colors : mesh.color_sets) copy(colors);
  for (MorphTarget& target : mesh.morph_targets) {
    copy(target.position_deltas);
    copy(target.normal_deltas);
    copy(target.tangent_deltas);
  }
  for (CustomAttribute& attribute : mesh.custom_attributes)
    for (std::uint32_t c = 0; c < attribute.components; ++c)
      attribute.values.push_back(float(attribute.values[vertex * attribute.components + c]));
  const auto of = mesh.weights.of(vertex);
  mesh.weights.append(std::vector<Influence>(of.begin(), of.end()));
  return mesh.vertex_count() - 1;
}

/// Gives the first triangles vertices of their own and a tear side, as a tear does.
inline void fake_tear(Mesh& mesh, std::size_t triangles = 2) {
  CustomAttribute side{kTearSideAttribute, 1, false,
                       std::vector<float>(mesh.positions.size(), 0.0f)};
  mesh.custom_attributes.push_back(side);
  for (std::size_t t = 0; t < std::min(triangles, mesh.triangles.size()); ++t)
    for (std::uint32_t& vertex : mesh.triangles[t]) {
      vertex = append_copy(mesh, vertex);
      mesh.custom_attributes.back().values.back() = 1.0f;
    }
}

/// Retires a triangle, as a gap does.
inline void retire(Mesh& mesh, std::uint32_t triangle) {
  mesh.triangles[triangle].fill(mesh.triangles[triangle][0]);
}

inline void retire_all(Mesh& mesh) {
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) retire(mesh, t);
}

}  // namespace sunder::test
