#include "scene/actor/piece_tissue.h"

#include <algorithm>

#include "core/internal/index_set.h"

namespace sunder::scene {

PieceTissue tissue_of(const DetachedPiece& piece, std::uint32_t point_count, const SoftBody& body) {
  PieceTissue tissue;
  IndexSet points(point_count);
  for (const DetachedPiece::OfMesh& of : piece.meshes)
    for (const auto& corners : of.old_points)
      for (const std::uint32_t point : corners) points.insert(point);
  tissue.points = points.list();
  tissue.motions.reserve(tissue.points.size());
  for (const std::uint32_t point : tissue.points) tissue.motions.push_back(body.motion_of(point));
  return tissue;
}

std::vector<PointMotion> motions_of(const DetachedPiece& piece, const PieceTissue& tissue,
                                    const Character& character, const ParticleSet& particles) {
  std::vector<PointMotion> motions(particles.point_count());
  const auto note = [&](std::uint32_t point, std::uint32_t old_point) {
    const auto at = std::lower_bound(tissue.points.begin(), tissue.points.end(), old_point);
    if (point != kNone && at != tissue.points.end() && *at == old_point)
      motions[point] = tissue.motions[static_cast<std::size_t>(at - tissue.points.begin())];
  };
  for (std::size_t m = 0; m < piece.meshes.size() && m < character.meshes.size(); ++m) {
    const std::vector<Triangle>& triangles = character.meshes[m].triangles;
    const auto points = particles.vertex_points(static_cast<std::uint32_t>(m));
    const auto& old_points = piece.meshes[m].old_points;
    for (std::size_t t = 0; t < std::min(triangles.size(), old_points.size()); ++t)
      for (std::size_t corner = 0; corner < 3; ++corner)
        note(points[triangles[t][corner]], old_points[t][corner]);
  }
  return motions;
}

}  // namespace sunder::scene
