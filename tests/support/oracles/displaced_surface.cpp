#include "support/oracles/displaced_surface.h"

#include <sunder/skinning/skinned_mesh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace sunder::test {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

/// Posed vertices of mesh 0.
struct Posed {
  Posed(const TornModel& model, const ModelPose& pose, const VertexDisplacements* displacements)
      : positions(model.character().meshes[0].vertex_count()),
        normals(positions.size()),
        tangents(positions.size()) {
    const Character& character = model.character();
    const Mesh& mesh = character.meshes[0];
    const Skin& skin = character.skins[mesh.skin];
    auto skinned = SkinnedMesh::create(source_of(mesh), skin.bones.size());
    auto palette = BonePalette::create(skin.bones.size(), character.rest_morph_weights.size());
    PosedBuffer buffer({mesh.vertex_count(),
                        {positions[0].data()},
                        {normals[0].data()},
                        {tangents[0].data()},
                        true});
    if (palette->set(skin, pose)) (void)skinned->deform(*palette, buffer, {}, displacements);
  }

  [[nodiscard]] Vec3d doubled_area(const Triangle& face) const {
    const Vec3d a = positions[face[0]].cast<double>();
    return (positions[face[1]].cast<double>() - a).cross(positions[face[2]].cast<double>() - a);
  }

  std::vector<Vec3f> positions, normals;
  std::vector<Vec4f> tangents;
};

/// Degrees; none if one has no length.
std::optional<double> angle(const Vec3d& a, const Vec3d& b) {
  if (!(a.norm() > 0 && b.norm() > 0)) return {};
  return kDegrees * std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Angles between the normals of vertices and the mean normals of their faces.
std::vector<std::optional<double>> angles_to_faces(const Mesh& mesh, const Posed& posed) {
  std::vector<Vec3d> sums(mesh.vertex_count(), Vec3d::Zero());
  for (const Triangle& face : mesh.triangles)
    for (const std::uint32_t v : face) sums[v] += posed.doubled_area(face);
  std::vector<std::optional<double>> angles(sums.size());
  for (std::size_t v = 0; v < sums.size(); ++v)
    angles[v] = angle(sums[v], posed.normals[v].cast<double>());
  return angles;
}

/// Angles between faces, by the two vertices that they share.
using Edge = std::pair<std::uint32_t, std::uint32_t>;
std::map<Edge, double> angles_between_faces(const Mesh& mesh, const Posed& posed) {
  std::map<Edge, Vec3d> first;
  std::map<Edge, double> angles;
  for (const Triangle& face : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge edge = std::minmax(face[k], face[(k + 1) % 3]);
      const auto [found, is_new] = first.emplace(edge, posed.doubled_area(face));
      if (is_new) continue;
      if (const auto between = angle(found->second, posed.doubled_area(face)))
        angles[edge] = *between;
    }
  return angles;
}

}  // namespace

void add_tangents(Mesh& mesh) {
  mesh.tangents.clear();
  for (const Vec3f& normal : mesh.normals) {
    const Vec3f across = normal.unitOrthogonal();
    mesh.tangents.emplace_back(across.x(), across.y(), across.z(), 1.0f);
  }
}

DisplacedSurface measure_displaced(const TornModel& model, const ModelPose& pose, ParticleSet& set,
                                   SoftBody& body, double from_tips) {
  const Mesh& mesh = model.character().meshes[0];
  const VertexDisplacements displacements = {set.vertex_points(0), set.influences(),
                                             body.displacements(), body.moved_vertices(model, 0),
                                             set.gradients(model), body.rotations()};
  const Posed rest(model, pose, nullptr), displaced(model, pose, &displacements);
  DisplacedSurface found;
  std::vector<Vec3f> tips;
  if (from_tips > 0)
    if (const auto points = find_tips(set, model))
      for (const std::uint32_t point : *points) tips.push_back(set.positions()[point]);
  const auto is_near_tip = [&](const Vec3f& at) {
    return std::ranges::any_of(
        tips, [&](const Vec3f& tip) { return double{(tip - at).norm()} < from_tips; });
  };
  std::vector<double> excess;
  const auto at_rest = angles_to_faces(mesh, rest), now = angles_to_faces(mesh, displaced);
  for (const IndexRange& range : displacements.moved)
    for (std::uint32_t v = range.first; v < range.first + range.count; ++v) {
      if (!at_rest[v] || !now[v]) continue;
      if (!is_near_tip(rest.positions[v])) excess.push_back(std::max(0.0, *now[v] - *at_rest[v]));
      const Vec3d n = displaced.normals[v].cast<double>(),
                  t = displaced.tangents[v].head<3>().cast<double>();
      found.tangent_dot = std::max(found.tangent_dot, std::abs(n.dot(t)));
    }
  std::sort(excess.begin(), excess.end());
  if (!excess.empty()) {
    found.normal_p99 = excess[(excess.size() - 1) * 99 / 100];
    found.normal_worst = excess.back();
  }
  const auto between_at_rest = angles_between_faces(mesh, rest);
  for (const auto& [edge, between] : angles_between_faces(mesh, displaced))
    if (const auto before = between_at_rest.find(edge); before != between_at_rest.end())
      found.jump = std::max(found.jump, between - before->second);
  return found;
}

}  // namespace sunder::test
