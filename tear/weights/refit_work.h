#pragma once

#include <sunder/operation/operation.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/refit_job.h>

#include <atomic>
#include <memory>
#include <vector>

#include "tear/weights/weigh.h"
#include "weights/internal/coupled_refit.h"

namespace sunder::tear {

/// What a refit needs to know of a model, and what comes of it. Only `state` is read by others
/// while it runs.
struct RefitWork {
  struct Point {
    AnimationPoint exact;
    Vec3d position = Vec3d::Zero();  ///< Bind position with the morph displacement of rest.
    Vec3d morph = Vec3d::Zero();     ///< The latter.
    Index skin = 0;
  };

  /// @param weighing  points of the editor's model, as `barycentric` has them.
  /// @param since     where the first of their operations began.
  RefitWork(std::shared_ptr<const Character> source, WeightsOperation operation, PoseSet poses,
            Weighing weighing, const SurfaceEditor::Mark& since, const SurfaceEditor& editor);

  void run();
  void cancel();

  std::shared_ptr<const Character> source;
  WeightsOperation operation;  ///< Resolved.
  PoseSet poses;
  Weighing weighing;  ///< In: as `barycentric` has it. Out: fitted.
  WeightReport report;
  std::vector<Point> points;
  std::vector<RefitNeighbours> neighbours;  ///< Where they are fitted together.
  std::vector<std::uint64_t> serials;       ///< Of the operations.
  Status failure;
  std::atomic<RefitJob::State> state = RefitJob::State::waiting;
  std::atomic<bool> is_cancelled = false;

 private:
  [[nodiscard]] Status fit(Index skin);
  template <class Fit>
  void take(std::size_t point, const Fit& fit);

  std::vector<Influence> fitted_;
};

}  // namespace sunder::tear
