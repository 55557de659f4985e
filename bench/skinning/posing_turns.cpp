#include "bench/skinning/posing_turns.h"

#include <algorithm>

#include "bench/harness/measure.h"
#include "bench/skinning/skinning_scene.h"

namespace sunder::bench {

void measure_posing(std::vector<PosingCandidate>& candidates, double vertices, int turns) {
  const int frames = std::max(6, static_cast<int>(2e6 / vertices));
  for (int turn = 0; turn < turns; ++turn)
    for (PosingCandidate& candidate : candidates) {
      for (const std::size_t pose : {0, 1}) candidate.run(pose);
      const double seconds = seconds_of([&] {
        for (int i = 0; i < frames; ++i)
          candidate.run(static_cast<std::size_t>(i) % SkinningScene::kPoses);
      });
      candidate.ns_per_vertex.push_back(1e9 * seconds / frames / vertices);
    }
}

}  // namespace sunder::bench
