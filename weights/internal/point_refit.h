#pragma once

#include <memory>
#include <span>

#include "weights/internal/animation_point.h"
#include "weights/internal/pose_moments.h"

namespace sunder {

/// The input of a fit.
struct PointToRefit {
  const AnimationPoint* exact = nullptr;  ///< The point to follow.
  /// Initial bind position, including morph displacements.
  Vec3d position = Vec3d::Zero();
  /// Initial influences: normalised, at most Options::maximum_influences, each with a slot of
  /// `exact`.
  std::span<const Influence> barycentric;
};

/// Fits the weights and the bind position of a point to its exact motion over a set of poses.
///
/// For a fixed bind position the mean squared distance is convex in the weights: a quadratic form
/// on the simplex, which an active set solves exactly. For fixed weights it is convex in the bind
/// position: three linear equations. The fit alternates between the two over all bones of the
/// point. If those are too many, it drops one bone after the other, each time the one whose removal
/// costs least, and alternates again over the rest. Not thread-safe: one object per thread.
class SUNDER_API PointRefit {
 public:
  PointRefit();
  ~PointRefit();

  struct Options {
    std::size_t maximum_influences = 4;  ///< K; 0: all bones of the point.
    bool moves_bind = true;              ///< Whether the bind position is fitted too.
  };
  struct Fit {
    /// By descending weight, sum 1. Valid until the next fit.
    std::span<const Influence> influences;
    Vec3d position = Vec3d::Zero();
    double mean_square = 0;              ///< Of the distance, in square metres.
    double barycentric_mean_square = 0;  ///< The same for the barycentric start.
    bool is_better = false;              ///< If false, the result is the barycentric start.
  };

  /// @param moments  PoseMoments::want() was called for `point.exact`; at least one pose was added.
  ///         O(bones squared) per iteration, a handful of iterations; no allocation once warm.
  [[nodiscard]] Fit fit(const PointToRefit& point, const Options& options,
                        const PoseMoments& moments);

 private:
  class Problem;
  std::unique_ptr<Problem> problem_;
};

}  // namespace sunder
