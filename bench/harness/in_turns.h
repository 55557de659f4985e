#pragma once

#include <functional>
#include <vector>

#include "bench/harness/measure.h"

namespace sunder::bench {

/// A candidate that is measured in turns with others.
struct Candidate {
  std::function<double()> run;  ///< Returns seconds.
  Effort effort;                ///< Seconds of one turn.
  int turns = 10;               ///< It takes part in.
  int warm_up = 3;              ///< Runs before each turn that are not counted.
  std::vector<double> seconds = {};
};

/// Runs the candidates in turn, round after round.
void measure_in_turns(std::vector<Candidate>& candidates);

}  // namespace sunder::bench
