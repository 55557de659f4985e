#include "support/models/cut_bodies.h"

#include <cmath>
#include <numeric>

namespace sunder::test {

Character character_of(const Solid& body) {
  Character character;
  character.skeleton.bones.push_back({});
  character.skeleton.bones[0].name = "body";
  character.skins.push_back({});
  character.skins[0].bones = {0};
  character.skins[0].bone_from_bind = {Affine3f::Identity()};
  Mesh& mesh = character.meshes.emplace_back();
  mesh.name = "body";
  mesh.submeshes.push_back({"outside", kNone});
  mesh.triangles = body.triangles;
  mesh.triangle_submesh.assign(body.triangles.size(), 0);
  for (const Vec3d& position : body.positions) {
    mesh.positions.push_back(position.cast<float>());
    mesh.weights.append(std::vector<Influence>{{0, 1.0f}});
  }
  return character;
}

std::array<Solid, 2> sides_of(const TornModel& model, const Vec3d& point, const Vec3d& normal) {
  const Mesh& mesh = model.character().meshes[0];
  Solid all;
  all.positions.resize(model.point_count(), Vec3d::Zero());
  std::vector<std::uint32_t> parent(model.point_count());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (is_retired(mesh.triangles[t])) continue;
    Triangle& triangle = all.triangles.emplace_back();
    for (std::uint32_t k = 0; k < 3; ++k) {
      triangle[k] = model.point_at(0, t, k);
      all.positions[triangle[k]] = mesh.positions[mesh.triangles[t][k]].cast<double>();
      parent[find(triangle[k])] = find(triangle[0]);
    }
  }
  std::vector<double> farthest(model.point_count(), 0);  // per component
  for (const Triangle& triangle : all.triangles)
    for (const std::uint32_t i : triangle) {
      const double distance = normal.dot(all.positions[i] - point);
      double& most = farthest[find(i)];
      if (std::abs(distance) > std::abs(most)) most = distance;
    }
  std::array<Solid, 2> sides;
  sides[0].positions = sides[1].positions = all.positions;
  for (const Triangle& triangle : all.triangles)
    sides[farthest[find(triangle[0])] > 0 ? 1 : 0].triangles.push_back(triangle);
  return sides;
}

}  // namespace sunder::test
