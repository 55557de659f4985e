#pragma once

#include <map>
#include <optional>
#include <vector>

#include "tear/weights/refit_bounds.h"
#include "tear/weights/refit_poses.h"
#include "tear/weights/refit_task.h"
#include "weights/internal/point_refit.h"
#include "weights/internal/pose_moments.h"

namespace sunder::tear {

/// Fits the points of a task that one skin moves.
///
/// The sum that is minimised is, over the groups of poses, the mean square of each group divided by
/// what all points of the skin have there with barycentric weights, times its importance.
/// RefitBounds holds the bounds over each group, over random poses and over the poses of the
/// operation. Fits are measured as they are stored, and those that the certificate refuses are
/// given up before the sums of an operation are compared, so nothing changes the sums afterwards.
class SkinRefit {
 public:
  /// @param points  of the task, that the skin moves; at least one.
  /// @param certificate  without points; outlives this.
  SkinRefit(const RefitTask& task, Index skin, std::vector<std::size_t> points,
            RefitCertificate& certificate);

  /// Fits the points. Stops early if the task is cancelled.
  [[nodiscard]] Status run();
  /// One per point, in the order of the constructor.
  [[nodiscard]] std::vector<PointFit> take_fits() { return std::move(fits_); }

 private:
  [[nodiscard]] Status add_poses();
  [[nodiscard]] Status add_own_poses();
  void set_bounds();
  void set_objective();
  void measure(std::size_t i, std::span<const Influence> influences, const Vec3d& position,
               std::span<double> squares);
  [[nodiscard]] PointToRefit to_refit(std::size_t i) const;
  [[nodiscard]] PointRefit::Options options() const;
  [[nodiscard]] bool gains(std::size_t i, double mean_square, double barycentric) const;
  void fit_alone();
  void fit(std::size_t i, PointRefit& refit);
  void take(std::size_t i, PointFit fit);
  void set_doubt(std::size_t i, std::span<const Influence> influences);
  [[nodiscard]] std::vector<std::size_t> tighten();
  [[nodiscard]] std::vector<double> posed_changes(std::span<const std::size_t> points,
                                                  std::size_t group);
  void add_posed_changes(std::span<const std::size_t> points, const ModelPose& pose, double share,
                         std::vector<double>& changes);
  void reject(std::size_t i);
  void keep_certified(std::span<const std::size_t> fitted);
  [[nodiscard]] Status fit_together();

  const RefitTask& task_;
  Index skin_;
  std::vector<std::size_t> points_;
  RefitCertificate& certificate_;
  std::vector<PointFit> fits_;
  PoseMoments moments_;  ///< Per group of poses, and last the sum that is minimised.
  std::optional<RefitPoses> poses_;
  std::map<Index, PoseMoments> own_;  ///< Per operation: the poses in which it was made.
  RefitBounds bounds_;  ///< Over each group of poses, and last over those of the operation.
  double square_ = 0;   ///< What a square metre over all groups adds to the sum that is minimised.
  std::vector<double> rounding_;  ///< Per point, posed, square metres; the most of all groups.
  /// Memory of measure().
  struct Scratch {
    std::vector<AnimationPoint::Term> terms, difference;
    std::vector<double> of_terms;
    std::vector<Affine3d> palette;
  } scratch_;
};

}  // namespace sunder::tear
