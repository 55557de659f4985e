#include "core/internal/digest.h"

#include <sunder/tear/torn_model.h>

namespace sunder {

std::uint64_t TornModel::digest() const {
  Digest digest;
  for (std::uint32_t m = 0; m < character().meshes.size(); ++m) {
    const Mesh& mesh = character().meshes[m];
    digest.add(mesh.positions);
    digest.add(mesh.normals);
    digest.add(mesh.tangents);
    digest.add(mesh.uv_sets);
    digest.add(mesh.color_sets);
    for (const CustomAttribute& attribute : mesh.custom_attributes) digest.add(attribute.values);
    digest.add(mesh.weights.first);
    digest.add(mesh.weights.influences);
    for (const MorphTarget& target : mesh.morph_targets) {
      digest.add(target.position_deltas);
      digest.add(target.normal_deltas);
      digest.add(target.tangent_deltas);
    }
    digest.add(mesh.triangles);
    digest.add(mesh.triangle_submesh);
    for (std::uint32_t vertex = source().meshes[m].vertex_count(); vertex < mesh.vertex_count();
         ++vertex) {
      const Birth born = birth(m, vertex);
      digest.add(born.triangle);
      for (const double coordinate : born.barycentric) digest.add(coordinate);
      // The mesh arrays of exact vertices equal those of interpolated ones.
      if (weight_policy(m, vertex) == WeightPolicy::exact) digest.add(vertex);
    }
  }
  return digest.value();
}

}  // namespace sunder
