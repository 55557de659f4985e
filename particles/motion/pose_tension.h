#pragma once

#include <sunder/particles/material.h>
#include <sunder/particles/particle_set.h>

#include "particles/clusters/surface_pose.h"
#include "particles/motion/spring_graph.h"

namespace sunder::particles {

/// The tension that a pose adds to the tissue at lips: a pose stretches or compresses the tissue
/// relative to the decomposition's pose.
class PoseTension {
 public:
  /// Makes room for the particles of a set. @throws std::bad_alloc
  void resize(Index particles);
  /// Evaluates the particles whose cells are at lips. O(particles + lip edges + those particles x
  /// neighbours x influences), no allocation.
  /// @param material_of  per particle.
  void update(const ParticleSet& set, const TornModel& model, const SurfacePose& pose,
              std::span<const SoftMaterial> materials, std::span<const Index> material_of,
              const SpringGraph& graph);

  /// Per particle: S (U - I), N/m, with the material's membrane stiffness S and the stretch U of
  /// the tissue around the particle; symmetric, in the plane of the surface and the decomposition's
  /// pose. Zero for particles that are not at lips.
  [[nodiscard]] std::span<const Mat3d> added() const { return added_; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  std::vector<Mat3d> added_;
  std::vector<Vec3d> posed_seeds_;  ///< Where `is_posed_`.
  std::vector<std::uint8_t> is_posed_, is_known_;
};

/// The unit direction across a plane, from moments of vectors in it: the longest column of their
/// adjugate. Zero if the vectors are all in a row.
[[nodiscard]] Vec3d across_plane(const Mat3d& moments);

/// The linear map of a plane that fits best how vectors in it change, in the plane's directions;
/// zero across it. Parameters as those of strain_of().
[[nodiscard]] Mat3d gradient_in_plane(const Mat3d& moments, const Mat3d& moved);

/// How much tissue is stretched, U - I in its plane, from how vectors in it change.
///
/// @param moments  the sum of weight * before * before^T.
/// @param moved    the sum of weight * after * before^T.
/// @return zero if the vectors are all in a row.
[[nodiscard]] Mat3d strain_of(const Mat3d& moments, const Mat3d& moved);

}  // namespace sunder::particles
