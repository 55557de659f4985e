#include "scene/actor/piece_tissue.h"

#include <algorithm>

namespace sunder::scene {

PieceTissue tissue_of(const DetachedPiece& piece, const ParticleSet& particles,
                      const SoftBody& body) {
  PieceTissue tissue;
  const std::span<const ParticleInfluences> influences = particles.influences();
  tissue.influences.reserve(piece.points.size());
  for (const std::uint32_t point : piece.points) tissue.influences.push_back(influences[point]);
  tissue.particles = body.particle_motions();
  return tissue;
}

std::vector<PointMotion> motions_of(const DetachedPiece& piece, const PieceTissue& tissue,
                                    const Character& character, const ParticleSet& particles) {
  std::vector<PointMotion> motions(particles.point_count());
  const auto note = [&](std::uint32_t point, std::uint32_t old_point) {
    if (point == kNone) return;
    const auto at = std::ranges::lower_bound(piece.points, old_point);
    const auto place = static_cast<std::size_t>(at - piece.points.begin());
    if (place < tissue.influences.size() && *at == old_point)
      motions[point] = motion_at(tissue.influences[place], tissue.particles);
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
