#pragma once

#include <sunder/operation/operation.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/refit_job.h>

#include <atomic>
#include <memory>
#include <vector>

#include "tear/weights/assign_weights.h"
#include "weights/internal/coupled_refit.h"

namespace sunder::tear {

/// A refit that runs in the background: a copy of its input, and its result. Other threads may
/// access only `state` and `is_cancelled` while it runs.
struct RefitTask {
  /// A point to fit.
  struct Point {
    AnimationPoint exact;
    Vec3d position = Vec3d::Zero();  ///< Bind position with the rest morph displacement.
    Vec3d morph = Vec3d::Zero();     ///< The rest morph displacement.
    Index skin = 0;
  };

  /// @param assignment  barycentric weights of points of the editor's model.
  /// @param since       where the first of their operations began.
  RefitTask(std::shared_ptr<const Character> source, WeightsOperation operation, PoseSet poses,
            WeightAssignment assignment, const EditLog::Mark& since, const SurfaceEditor& editor);

  void run();
  void cancel();

  std::shared_ptr<const Character> source;
  WeightsOperation operation;  ///< Resolved.
  PoseSet poses;
  WeightAssignment assignment;  ///< In: barycentric. Out: fitted.
  WeightReport report;
  std::vector<Point> points;
  std::vector<RefitNeighbours> neighbours;  ///< If the points are fitted together.
  std::vector<std::uint64_t> serials;       ///< Serials of the operations.
  Status failure;
  std::atomic<RefitJob::State> state = RefitJob::State::waiting;
  std::atomic<bool> is_cancelled = false;

 private:
  [[nodiscard]] Status fit(Index skin);
  [[nodiscard]] Status add_poses(Index skin, PoseMoments& moments) const;
  [[nodiscard]] Status fit_together(std::span<const std::size_t> of_skin,
                                    const PoseMoments& moments);
  [[nodiscard]] PointRefit::Options options() const;
  [[nodiscard]] PointToRefit to_refit(std::size_t point) const;
  /// Stores the fit of a point, or keeps its weights if the fit is not better.
  template <class Fit>
  void take(std::size_t point, const Fit& fit);

  std::vector<Influence> fitted_;
};

}  // namespace sunder::tear
