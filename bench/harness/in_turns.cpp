#include "bench/harness/in_turns.h"

#include <algorithm>

namespace sunder::bench {

void measure_in_turns(std::vector<Candidate>& candidates) {
  int rounds = 0;
  for (const Candidate& candidate : candidates) rounds = std::max(rounds, candidate.turns);
  for (int round = 0; round < rounds; ++round)
    for (Candidate& candidate : candidates) {
      if (round >= candidate.turns) continue;
      for (int i = 0; i < candidate.warm_up; ++i) candidate.run();
      const auto seconds = sample(candidate.effort, candidate.run);
      candidate.seconds.insert(candidate.seconds.end(), seconds.begin(), seconds.end());
    }
}

}  // namespace sunder::bench
