#pragma once

#include <algorithm>

#include "core/internal/ordered.h"
#include "particles/clusters/lip_border.h"
#include "particles/clusters/structure.h"
#include "particles/internal/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::particles {

// The surface is divided into cells, one per particle: each point is in the cell of the particle
// whose seed is nearest. The cells are the finite volumes of a membrane. Walls and caps are no part
// of it.

/// The membership with the least distance from the seed; kNone without memberships.
[[nodiscard]] inline Index owner_of(std::span<const ParticleMembership> memberships,
                                    std::span<const Particle> particles) {
  Index owner = kNone;
  float nearest = 0;
  for (const ParticleMembership& membership : memberships) {
    const float distance = membership.reach * particles[membership.particle].range;
    if (owner != kNone && !(distance < nearest)) continue;
    nearest = distance;
    owner = membership.particle;
  }
  return owner;
}

/// The shape of a face that is divided among the cells of its points.
class FaceOfCells {
 public:
  FaceOfCells(std::span<const Vec3f> positions, const std::array<Index, 3>& points) {
    for (std::size_t k = 0; k < 3; ++k) at_[k] = positions[points[k]].cast<double>();
    twice_area_ = norm(Vec3d((at_[1] - at_[0]).cross(at_[2] - at_[0])));
  }

  /// Calls add_area(particle, area) for each corner, and for each edge between two cells
  /// add_border(p, q, across, middle): the part of the border of the cells p and q in this face, as
  /// its conormal towards q times its length, and the middle of the edge. The border runs from the
  /// middle of the edge to the face's circumcentre, so the conormal is half the cotangent of the
  /// opposite angle times the edge.
  template <class AddArea, class AddBorder>
  void divide(const std::array<Index, 3>& owners, AddArea add_area, AddBorder add_border) const {
    if (!(twice_area_ > 0)) return;
    for (std::size_t k = 0; k < 3; ++k)
      if (owners[k] != kNone) add_area(owners[k], twice_area_ / 6);
    if ((owners[0] == owners[1] && owners[1] == owners[2]) || is_needle()) return;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, opposite = (i + 2) % 3;
      if (owners[i] == owners[j] || owners[i] == kNone || owners[j] == kNone) continue;
      const double cotangent =
          dot(Vec3d(at_[i] - at_[opposite]), Vec3d(at_[j] - at_[opposite])) / twice_area_;
      add_border(owners[i], owners[j], Vec3d(0.5 * cotangent * (at_[j] - at_[i])),
                 Vec3d(0.5 * (at_[i] + at_[j])));
    }
  }

 private:
  [[nodiscard]] bool is_needle() const {
    const double longest =
        std::max({squared_norm(Vec3d(at_[1] - at_[0])), squared_norm(Vec3d(at_[2] - at_[1])),
                  squared_norm(Vec3d(at_[0] - at_[2]))});
    return !(twice_area_ > kNeedleFraction * longest);
  }

  std::array<Vec3d, 3> at_;
  double twice_area_ = 0;
};

/// Whether a triangle is divided into cells: it is no wall or cap, and has three points.
[[nodiscard]] inline bool has_cells(const tear::Surface& surface, Index triangle) {
  return !surface.has_repeated_point(triangle) && !is_filling(surface, triangle);
}

[[nodiscard]] inline std::array<Index, 3> points_of(const tear::Surface& surface, Index triangle) {
  const Index* points = &surface.corner_point[3 * std::size_t{triangle}];
  return {points[0], points[1], points[2]};
}

[[nodiscard]] inline std::array<Index, 3> owners_of(const Structure& structure,
                                                    const std::array<Index, 3>& points) {
  const std::vector<Index>& owners = structure.points.owners;
  return {owners[points[0]], owners[points[1]], owners[points[2]]};
}

/// ParticleNeighbour::coupling from the other sums. Where two seeds are much nearer to one another
/// than to their border, as on the two lips next to a tip, the path across the border counts.
[[nodiscard]] double coupling_of(const Structure& structure, Index particle,
                                 const ParticleNeighbour& neighbour);

/// Computes the areas, neighbours and couplings of all particles, which have none yet, from the
/// owners of points. O(faces), expected.
void sum_cells(const tear::Surface& surface, Structure& structure);

}  // namespace sunder::particles
