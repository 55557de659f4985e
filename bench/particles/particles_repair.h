#pragma once

#include <sunder/particles/particle_set.h>

#include <memory>
#include <vector>

#include "bench/tear/tear_scene.h"

namespace sunder::bench {

/// Repeats on the scene's model, each time in another pose: particles follow a tear across about a
/// hundred faces, settle, and follow its undo.
class RepeatedRepair {
 public:
  ///
  /// @param range  of a particle, as a fraction of the diagonal.
  RepeatedRepair(const Scene& scene, double range);

  ///
  /// @return the seconds of ParticleSet::follow() after the tear, without the work of the model.
  double run();

  struct Figures {
    std::uint32_t points = 0, particles = 0, faces_crossed = 0;
    double members = 0;  ///< Mean per particle.
    double bytes = 0;    ///< Memory of the set after tears.
    double follow = 0, settle = 0,
           undo = 0;   ///< Medians, seconds; `settle` is all calls after one tear.
    double first = 0;  ///< follow() of the set's first tear, seconds.
    double settle_calls = 0, longest_settle_call = 0;  ///< Medians; the call in seconds.
  };
  /// Figures of all runs after the first, which warms up.
  [[nodiscard]] Figures figures() const;

 private:
  const Scene& scene_;
  std::unique_ptr<ParticleSet> set_;
  ChangeRecord change_;
  Figures figures_;
  std::vector<double> follow_, settle_, undo_, settle_calls_, longest_settle_call_;
};

}  // namespace sunder::bench
