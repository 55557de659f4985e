#include "bench/tear/removal_times.h"

#include <algorithm>
#include <cstddef>

#include "bench/harness/in_turns.h"
#include "bench/tear/repeated_operation.h"

namespace sunder::bench {

RemovalTimes measure_removals(const Scene& scene) {
  std::array<RepeatedOperation, 4> operations = {{{scene, tear_along_stroke},
                                                  {scene, tear_with_width},
                                                  {scene, drill_open},
                                                  {scene, drill_through}}};
  std::vector<Candidate> candidates;
  for (RepeatedOperation& operation : operations)
    candidates.push_back({[&operation] { return operation.run(); }, {30, 0.5, 2}});
  measure_in_turns(candidates);
  const auto by_tear = [&](std::size_t candidate) {
    return median(candidates[candidate].seconds) / median(candidates[0].seconds);
  };
  RemovalTimes result;
  result.width = by_tear(1);
  result.bore = by_tear(2);
  result.walled_bore = by_tear(3);
  for (const std::size_t of : {1, 2}) {
    result.allocations =
        std::max(result.allocations, static_cast<double>(operations[of].allocations));
    result.undo_allocations =
        std::max(result.undo_allocations, static_cast<double>(operations[of].undo_allocations));
  }
  return result;
}

double width_vs_tear() {
  double worst = 0;
  for (const int divisions : kDivisions) {
    const RemovalTimes times = measure_removals(scene_of(divisions));
    worst = std::max({worst, times.width, times.bore});
  }
  return worst;
}

}  // namespace sunder::bench
