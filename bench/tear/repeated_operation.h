#pragma once

#include <sunder/tear/torn_model.h>

#include "bench/tear/tear_scene.h"

namespace sunder::bench {

/// State of the caches before the measured operation.
enum class Caches : std::uint8_t { warm, swept };

/// Repeats one operation and its undo on the scene's model, with one change record, each time in
/// another pose.
class RepeatedOperation {
 public:
  using Work = Result<TearReport> (*)(const Scene& scene, const ModelPose& pose,
                                      ChangeRecord& change);

  RepeatedOperation(const Scene& scene, Work work) : scene_(scene), work_(work) {}

  ///
  /// @return seconds of the operation; its undo is not timed.
  double run(Caches caches = Caches::warm);

  struct Seconds {
    double undo = 0, redo = 0;
  };
  /// Does the operation, undoes, redoes and undoes it again.
  Seconds run_undo_and_redo();

  // Results of the last run.
  TearReport report;
  std::uint64_t allocations = 0;       ///< By the operation.
  std::uint64_t undo_allocations = 0;  ///< By its undo.

 private:
  void take_back();

  const Scene& scene_;
  Work work_;
  ChangeRecord change_;
};

// Operations.
Result<TearReport> tear_along_stroke(const Scene& scene, const ModelPose& pose,
                                     ChangeRecord& change);
Result<TearReport> tear_with_width(const Scene& scene, const ModelPose& pose, ChangeRecord& change);
Result<TearReport> cut_in_two(const Scene& scene, const ModelPose& pose, ChangeRecord& change);
Result<TearReport> cut_with_caps(const Scene& scene, const ModelPose& pose, ChangeRecord& change);
/// A bore with a wall.
Result<TearReport> drill_through(const Scene& scene, const ModelPose& pose, ChangeRecord& change);
/// A bore without a wall, whose rim crosses about as many faces as the stroke.
Result<TearReport> drill_open(const Scene& scene, const ModelPose& pose, ChangeRecord& change);

/// Seconds until a new model tears at full speed.
struct FirstTear {
  double create = 0;
  double tear = 0;  ///< The first tear, with all structures that are built on first use.
};
[[nodiscard]] FirstTear time_first_tear(const Scene& scene);

}  // namespace sunder::bench
