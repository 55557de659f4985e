#include "pipeline/plan/align_stroke.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace sunder::plan {
namespace {

/// A stroke is backwards only if that is clearly nearer.
constexpr double kNearer = 0.99;

struct Alignment {
  std::vector<std::size_t> steps;
  double cost = 0;
};

/// The best alignment in one direction.
Alignment aligned(std::span<const float> squares, std::size_t steps, bool is_closed,
                  bool is_backwards) {
  const std::size_t blades = squares.size() / steps;
  const std::size_t columns = is_closed ? 2 * steps - 1 : steps;
  const auto square = [&](std::size_t blade, std::size_t column) {
    const std::size_t step = column < steps ? column : column - (steps - 1);
    return squares[blade * steps + (is_backwards ? steps - 1 - step : step)];
  };
  std::vector<double> costs(columns, 0.0);
  std::vector<std::uint32_t> before(blades * columns);
  for (std::size_t blade = 0; blade < blades; ++blade) {
    std::size_t best = 0;  // the cheapest column so far, of the blade before
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t column = 0; column < columns; ++column) {
      if (costs[column] < least) {
        least = costs[column];
        best = column;
      }
      before[blade * columns + column] = static_cast<std::uint32_t>(best);
      costs[column] = least + static_cast<double>(square(blade, column));
    }
  }
  const auto cheapest = std::min_element(costs.begin(), costs.end());
  Alignment found{std::vector<std::size_t>(blades), *cheapest};
  auto column = static_cast<std::size_t>(cheapest - costs.begin());
  for (std::size_t blade = blades; blade-- > 0;) {
    found.steps[blade] = column;
    column = before[blade * columns + column];
  }
  return found;
}

}  // namespace

AlignedStroke align_stroke(std::span<const float> squares, std::size_t steps, bool is_closed) {
  Alignment forwards = aligned(squares, steps, is_closed, false);
  Alignment backwards = aligned(squares, steps, is_closed, true);
  if (backwards.cost < kNearer * forwards.cost) return {std::move(backwards.steps), true};
  return {std::move(forwards.steps), false};
}

}  // namespace sunder::plan
