#pragma once

#include <vector>

#include "support/machine/random.h"
#include "weights/internal/coupled_refit.h"

namespace sunder::test {

struct RefitScene {
  std::uint32_t points = 40;
  std::uint32_t slots = 8;
  std::uint32_t poses = 12;
  std::size_t maximum_influences = 4;  ///< Number of barycentric weights kept; 0: all.
  double angle = 0.6;                  ///< Largest rotation of a bone, radians.
  double face = 0.15;                  ///< Size of the triangles in which the points lie, metres.
  Vec3d centre = Vec3d::Zero();        ///< Position of the character.
};

/// A lip of a tear: points in triangles along a chain of bones two metres long, up to four
/// influences per corner.
struct Lip {
  std::vector<std::vector<Affine3d>> palettes;  ///< One a pose.
  std::vector<AnimationPoint> exact;
  std::vector<std::vector<Influence>> barycentric;
  std::vector<PointToRefit> points;
  /// Pairs along the lip, and two untorn neighbours per point.
  std::vector<RefitNeighbours> neighbours;
  std::vector<PoseMoments> moments;  ///< One.

  Lip(Random& random, const RefitScene& wanted);
  Lip(const Lip&) = delete;
  Lip& operator=(const Lip&) = delete;

  /// The exact position of a point in a pose, with weights that sum to exactly one.
  [[nodiscard]] Vec3d target(std::size_t point, std::size_t pose) const;
  /// Mean squared distance over the poses, pose by pose.
  [[nodiscard]] double mean_square(std::size_t point, std::span<const Influence> influences,
                                   const Vec3d& position) const;
};

/// Each bone rotated about its joint, together with the bones below it.
[[nodiscard]] std::vector<Affine3d> bent_chain(Random& random, std::uint32_t slots, double angle,
                                               const Vec3d& centre);

}  // namespace sunder::test
