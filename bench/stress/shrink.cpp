#include "bench/stress/shrink.h"

#include <algorithm>

namespace sunder::stress {
namespace {

/// No family has more steps in a case.
constexpr std::uint32_t kMostSteps = 1000;

bool breaks(const Outcome& outcome, const std::string& law) {
  const auto& violations = outcome.report.violations;
  return std::any_of(violations.begin(), violations.end(),
                     [&](const Violation& violation) { return violation.law == law; });
}

}  // namespace

Steps shrink(const Outcome& failed, double seconds_of_case) {
  const std::string& law = failed.report.violations.at(0).law;
  if (law == "hang") return {};  // Each attempt would take as long.
  std::set<std::uint32_t> kept;
  for (std::uint32_t step = 1; step <= kMostSteps; ++step) kept.insert(step);
  // Runs of steps first, then one by one.
  for (std::uint32_t length = kMostSteps / 2; length > 0; length /= 2)
    for (std::uint32_t first = 1; first <= kMostSteps; first += length) {
      std::set<std::uint32_t> fewer = kept;
      fewer.erase(fewer.lower_bound(first), fewer.lower_bound(first + length));
      if (fewer.size() == kept.size()) continue;
      if (breaks(run_apart(failed.name, Steps(fewer), seconds_of_case), law))
        kept = std::move(fewer);
    }
  return Steps(std::move(kept));
}

}  // namespace sunder::stress
