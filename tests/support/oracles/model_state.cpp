#include "support/oracles/model_state.h"

#include <algorithm>

#include "support/machine/say.h"

namespace sunder::test {
namespace {

std::string difference_of_meshes(const Character& a, const Character& b) {
  for (std::size_t m = 0; m < std::min(a.meshes.size(), b.meshes.size()); ++m) {
    const Mesh &in_a = a.meshes[m], &in_b = b.meshes[m];
    if (in_a.positions != in_b.positions) return say("positions of mesh ", m);
    if (in_a.triangles != in_b.triangles) return say("triangles of mesh ", m);
    if (in_a.custom_attributes != in_b.custom_attributes)
      return say("custom attributes of mesh ", m);
    if (in_a.submeshes != in_b.submeshes || in_a.triangle_submesh != in_b.triangle_submesh)
      return say("submeshes of mesh ", m);
    if (in_a != in_b) return say("an attribute of mesh ", m);
  }
  return a == b ? "" : "something but the meshes";
}

}  // namespace

bool are_same(const Birth& a, const Birth& b) {
  return a.triangle == b.triangle && a.barycentric == b.barycentric;
}

ModelState state_of(const TornModel& model) {
  ModelState state{model.character(), model.digest(), model.point_count(), {}};
  for (std::uint32_t m = 0; m < state.character.meshes.size(); ++m) {
    auto& of_mesh = state.meshes.emplace_back();
    const Mesh& mesh = state.character.meshes[m];
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      of_mesh.source_triangles.push_back(model.source_triangle(m, t));
      for (std::uint32_t k = 0; k < 3; ++k) of_mesh.points.push_back(model.point_at(m, t, k));
    }
    for (std::uint32_t v = model.source().meshes[m].vertex_count(); v < mesh.vertex_count(); ++v)
      of_mesh.births.push_back(model.birth(m, v));
    const auto fillings = model.fillings(m);
    of_mesh.fillings.assign(fillings.begin(), fillings.end());
  }
  return state;
}

std::string difference(const ModelState& a, const ModelState& b) {
  if (const std::string meshes = difference_of_meshes(a.character, b.character); !meshes.empty())
    return meshes;
  if (a.point_count != b.point_count)
    return say("point count: ", a.point_count, " and ", b.point_count);
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    const auto &in_a = a.meshes[m], &in_b = b.meshes[m];
    if (in_a.points != in_b.points) return say("points of mesh ", m);
    if (!std::ranges::equal(in_a.births, in_b.births, are_same)) return say("births of mesh ", m);
    if (in_a.source_triangles != in_b.source_triangles) return say("source triangles of mesh ", m);
    if (in_a.fillings != in_b.fillings) return say("fillings of mesh ", m);
  }
  return a.digest == b.digest ? "" : "digest";
}

}  // namespace sunder::test
