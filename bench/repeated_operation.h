#pragma once

#include <sunder/tear/torn_model.h>

#include "bench/tear_scene.h"

namespace sunder::bench {

/// How the caches are before something is timed.
enum class Caches : std::uint8_t { warm, swept };

/// Does one operation and takes it back, again and again, on the scene's model and with one change
/// record, each time in another pose.
class RepeatedOperation {
 public:
  using Work = Result<TearReport> (*)(const Scene& scene, const ModelPose& pose,
                                      ChangeRecord& change);

  RepeatedOperation(const Scene& scene, Work work) : scene_(scene), work_(work) {}

  /// @return the seconds that the operation took; it is taken back outside of what is measured.
  double run(Caches caches = Caches::warm);

  struct Seconds {
    double undo = 0, redo = 0;
  };
  /// Does the operation, takes it back, does it again and takes it back once more.
  Seconds run_undo_and_redo();

  // Results of the last run.
  TearReport report;
  std::uint64_t allocations = 0;       ///< By the operation alone.
  std::uint64_t undo_allocations = 0;  ///< By taking it back.

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
Result<TearReport> drill_through(const Scene& scene, const ModelPose& pose, ChangeRecord& change);

/// Seconds that a fresh model takes before it tears at full speed.
struct FirstTear {
  double create = 0;
  double tear = 0;  ///< The first one, with whatever is built when it is first needed.
};
[[nodiscard]] FirstTear time_first_tear(const Scene& scene);

}  // namespace sunder::bench
