#pragma once

#include <map>
#include <optional>
#include <vector>

#include "tear/weights/refit_poses.h"
#include "tear/weights/refit_task.h"
#include "weights/internal/point_refit.h"
#include "weights/internal/pose_moments.h"

namespace sunder::tear {

/// Fits the points of a task that one skin moves.
///
/// The sum that is minimised is, over the groups of poses, the mean square of each group divided by
/// what all points of the skin have there with barycentric weights, times its importance. The bound
/// of a point in a group is what the point itself has there with barycentric weights. Only over the
/// random poses it has slack, which is reduced until all points together are not worse there.
class SkinRefit {
 public:
  /// @param points  of the task, that the skin moves; at least one.
  SkinRefit(const RefitTask& task, Index skin, std::vector<std::size_t> points);

  /// Fits the points. Stops early if the task is cancelled.
  [[nodiscard]] Status run();
  /// One per point, in the order of the constructor.
  [[nodiscard]] std::vector<PointFit> take_fits() { return std::move(fits_); }

 private:
  [[nodiscard]] Status add_poses();
  [[nodiscard]] Status add_own_poses();
  void set_bounds();
  void set_bounds_of(std::size_t i, const PointToRefit& point);
  void set_objective();
  [[nodiscard]] bool keeps_random_poses() const;
  [[nodiscard]] PointToRefit to_refit(std::size_t i) const;
  [[nodiscard]] PointRefit::Options options() const;
  [[nodiscard]] bool gains(std::size_t i, double mean_square, double barycentric) const;
  void fit_alone();
  void fit_each();
  [[nodiscard]] Status fit_together();

  const RefitTask& task_;
  Index skin_;
  std::vector<std::size_t> points_;
  std::vector<PointFit> fits_;
  PoseMoments moments_;  ///< Per group of poses, and last the sum that is minimised.
  std::optional<RefitPoses> poses_;
  std::map<Index, PoseMoments> own_;  ///< Per operation: the poses in which it was made.

  /// The bounds of a point.
  struct Bounds {
    double own = 0;         ///< Over the poses of its operation, square metres.
    double random = 0;      ///< Over the random poses, square metres.
    double rounding = 0;    ///< Of a stored position, posed, square metres; the most of all groups.
    double most = 0;        ///< The largest mean square over the groups that count.
    bool is_exact = false;  ///< Over some group barycentric weights are exact.
  };
  std::vector<Bounds> bounds_;   ///< Per point.
  std::vector<double> allowed_;  ///< Points x groups, square metres.
  std::size_t random_ = 0;       ///< The group of the random poses; the number of groups: none.
};

}  // namespace sunder::tear
