#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace sunder::bench {

/// A way to pose the whole crowd once.
struct PosingCandidate {
  const char* name;
  std::function<void(std::size_t pose)> run;
  std::vector<double> ns_per_vertex = {};
};

/// Runs the candidates in turns. A turn is as many frames as take about two milliseconds or more,
/// after two frames that are not counted.
void measure_posing(std::vector<PosingCandidate>& candidates, double vertices, int turns);

}  // namespace sunder::bench
