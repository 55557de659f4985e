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
  /// The largest mean squared distances that a fit may have, square metres: one for each of the
  /// first groups of the moments. The initial weights must not exceed them. Empty: no bounds.
  std::span<const double> allowed = {};
  /// Further poses of this point alone, as the only group; nullptr: none.
  const PoseMoments* own_poses = nullptr;
  double own_allowed = 0;  ///< The bound over `own_poses`, square metres.
  bool may_move = true;    ///< If false, the bind position stays, whatever the options say.
};

/// Fits the weights and the bind position of a point to its exact motion over a set of poses.
///
/// For a fixed bind position the mean squared distance is convex in the weights: a quadratic form
/// on the simplex, which an active set solves exactly. For fixed weights it is convex in the bind
/// position: three linear equations. The fit alternates between the two over all bones of the
/// point. If those are too many, it drops one bone after the other, each time the one whose removal
/// costs least, and alternates again over the rest. If the fit exceeds a bound, the groups that are
/// worse than allowed are added to the objective with multipliers, which are searched for until all
/// bounds hold. Not thread-safe: one object per thread.
class SUNDER_API PointRefit {
 public:
  PointRefit();
  ~PointRefit();

  struct Options {
    std::size_t maximum_influences = 4;  ///< K; 0: all bones of the point.
    bool moves_bind = true;              ///< Whether the bind position is fitted too.
    std::size_t group = 0;               ///< The group of the moments that is minimised.
  };
  struct Fit {
    /// By descending weight, sum 1. Valid until the next fit.
    std::span<const Influence> influences;
    Vec3d position = Vec3d::Zero();
    double mean_square = 0;              ///< Over the minimised group.
    double barycentric_mean_square = 0;  ///< The same for the barycentric start.
    bool is_better = false;              ///< If false, the result is the barycentric start.
  };

  /// @param moments  PoseMoments::want() was called for `point.exact`; at least one pose was added.
  ///         O(bones squared) per iteration, a handful of iterations, and O(bones squared) per
  ///         bound; no allocation once warm.
  [[nodiscard]] Fit fit(const PointToRefit& point, const Options& options,
                        const PoseMoments& moments);

 private:
  class Problem;
  std::unique_ptr<Problem> problem_;
};

}  // namespace sunder
