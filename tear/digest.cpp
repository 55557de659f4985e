#include "core/internal/digest.h"

#include <sunder/tear/torn_model.h>

#include "tear/model/model_state.h"

namespace sunder {

namespace {

/// As Digest::add() of Mesh::triangle_submesh, with other numbers.
template <class SubmeshOf>
void add_submeshes(const Mesh& mesh, SubmeshOf submesh_of, Digest& digest) {
  digest.add(mesh.triangle_count());
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) digest.add(submesh_of(t));
}

}  // namespace

std::uint64_t TornModel::digest() const {
  Digest digest;
  const State* const torn = torn_state();
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
    add_submeshes(
        mesh,
        [&](std::uint32_t triangle) {
          return torn == nullptr
                     ? mesh.triangle_submesh[triangle]
                     : torn->editor.fillings.submesh_of_group(torn->editor.surface().triangle(
                           torn->editor.origins.surface_triangle(m, triangle)));
        },
        digest);
    for (std::uint32_t vertex = source().meshes[m].vertex_count(); vertex < mesh.vertex_count();
         ++vertex) {
      const Birth born = birth(m, vertex);
      digest.add(born.triangle);
      for (const double coordinate : born.barycentric) digest.add(coordinate);
      // The mesh arrays of exact vertices equal those of interpolated ones.
      if (weight_policy(m, vertex) == WeightPolicy::exact) digest.add(vertex);
    }
  }
  for (const SutureThread& thread : threads_of(*this)) {
    digest.add(thread.left);
    digest.add(thread.right);
    for (const double value : {thread.stiffness, thread.tension, thread.strength})
      digest.add(value);
  }
  return digest.value();
}

}  // namespace sunder
