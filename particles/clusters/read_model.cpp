#include "particles/clusters/read_model.h"

#include <utility>

#include "core/internal/ordered.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// The edge length is the mean over about this many edges, spread over the surface.
constexpr Index kEdgesMeasured = 1024;

void read_vertices(const Character& character, const Surface& surface, Structure& structure) {
  std::vector<std::vector<Index>>& of_mesh = structure.vertex_points.of_mesh;
  of_mesh.resize(character.meshes.size());
  for (Index m = 0; m < character.meshes.size(); ++m)
    of_mesh[m].assign(character.meshes[m].vertex_count(), kNone);
  structure.points.vertices.resize(surface.point_count());
  for (Index t = 0; t < surface.triangle_count(); ++t) {
    if (surface.has_repeated_point(t)) continue;
    const tear::TriangleRef ref = surface.triangle(t);
    const Triangle& triangle = character.meshes[ref.mesh].triangles[ref.triangle];
    for (Index k = 0; k < 3; ++k) {
      const Index now = surface.corner_point[3 * t + k];
      const Index before = std::exchange(of_mesh[ref.mesh][triangle[k]], now);
      if ((before != kNone) & (before != now))
        structure.vertex_points.share(ref.mesh, triangle[k], before, now);
      structure.points.vertices[now] = {ref.mesh, triangle[k]};
    }
  }
}

float mean_edge_length(std::span<const Vec3f> positions, const Surface& surface) {
  const Index corners = 3 * surface.triangle_count(), step = corners / kEdgesMeasured + 1;
  double sum = 0;
  std::size_t count = 0;
  for (Index c = 0; c < corners; c += step) {
    if (surface.has_repeated_point(c / 3)) continue;
    const Vec3f &a = positions[surface.corner_point[c]],
                &b = positions[surface.corner_point[Surface::next(c)]];
    sum += norm(b - a);
    ++count;
  }
  return count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0.0f;
}

}  // namespace

void read_model(const TornModel& model, const ModelPose& pose, Structure& structure) {
  const Character& character = model.character();
  const Surface& surface = model.surface();
  CharacterLink& link = structure.character;
  link.source = &model.source();
  link.skins = character.skins;
  link.decomposition_pose = DecompositionPose(character, pose);
  link.border = SourceBorder(model);
  link.first_slots.assign(1, 0);
  for (const Skin& skin : link.skins)
    link.first_slots.push_back(link.first_slots.back() + static_cast<Index>(skin.bones.size()));
  PointTable& points = structure.points;
  points.positions.resize(surface.point_count(), Vec3f::Zero());
  read_vertices(character, surface, structure);
  for (Index p = 0; p < surface.point_count(); ++p)
    if (const VertexRef& of = points.vertices[p]; of.vertex != kNone)
      points.positions[p] = link.decomposition_pose.place(character.meshes[of.mesh], of.vertex);
  structure.character.edge_length = mean_edge_length(points.positions, surface);
}

double diagonal_of(const Structure& structure, const TornModel& model) {
  Eigen::AlignedBox3f box;
  for (Index p = 0; p < structure.points.count(); ++p)
    if (model.surface().point_corner[p] != kNone)
      box.extend(Eigen::Vector3f(structure.points.positions[p]));
  return box.isEmpty() ? 0.0 : double{norm(box.diagonal())};
}

}  // namespace sunder::particles
