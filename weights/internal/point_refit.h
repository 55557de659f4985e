#pragma once

#include <memory>
#include <span>

#include "weights/internal/animation_point.h"
#include "weights/internal/pose_moments.h"

namespace sunder {

/// What a fit starts from.
struct PointToRefit {
  const AnimationPoint* exact = nullptr;  ///< What it is to follow.
  Vec3d position = Vec3d::Zero();  ///< Bind position, in the middle of what it may become; morph
                                   ///< displacements included.
  std::span<const Influence> barycentric;  ///< The influences that it has: normalised, no more than
                                           ///< are wanted, a slot of `exact` each.
};

/// Weights, and a bind position, that follow a point better than its interpolated ones, over a set
/// of poses.
///
/// For a fixed bind position the mean squared distance is convex in the weights: a quadratic form
/// on the simplex, solved exactly by an active set. For fixed weights it is convex in the bind
/// position: three linear equations. The two take turns, first over all bones that move the point;
/// where those are more than wanted, one after the other goes, each time the one that costs least,
/// and they take turns over those that are left.
class SUNDER_API PointRefit {
 public:
  PointRefit();
  ~PointRefit();

  struct Options {
    std::size_t maximum_influences = 4;  ///< K; 0: as many as move the point.
    bool moves_bind = true;              ///< Whether the bind position is fitted too.
  };
  struct Fit {
    std::span<const Influence> influences;  ///< Largest first, sum 1. Valid until the next fit.
    Vec3d position = Vec3d::Zero();
    double mean_square = 0;              ///< Of the distance, square metres.
    double barycentric_mean_square = 0;  ///< The same of what it started from.
    bool is_better = false;              ///< Otherwise the fit is what it started from.
  };

  /// @param moments  that were asked for the pairs of `point.exact`, and hold at least one pose.
  /// O(bones squared) a round, a handful of rounds; no allocation once warm.
  [[nodiscard]] Fit fit(const PointToRefit& point, const Options& options,
                        const PoseMoments& moments);

 private:
  class Problem;
  std::unique_ptr<Problem> problem_;
};

}  // namespace sunder
