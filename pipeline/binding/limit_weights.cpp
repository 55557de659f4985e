#include "pipeline/binding/limit_weights.h"

#include <algorithm>

namespace sunder::binding {
namespace {

constexpr double kNegligible = 1e-3;  ///< Of the largest weight.

void normalise(WeightRow& row) {
  double sum = 0;
  for (const BoneWeight& entry : row) sum += entry.weight;
  for (BoneWeight& entry : row) entry.weight /= sum;
}

}  // namespace

double limit_weights(std::size_t maximum, WeightRow& row) {
  normalise(row);
  std::ranges::sort(row, [](const BoneWeight& a, const BoneWeight& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.bone < b.bone;
  });
  const bool is_limited = maximum > 0 && row.size() > maximum;
  double dropped = 0;
  for (std::size_t i = maximum; is_limited && i < row.size(); ++i) dropped += row[i].weight;
  double level = kNegligible * row.front().weight;
  if (is_limited) level = std::max(level, row[maximum].weight);
  WeightRow kept;
  for (const BoneWeight& entry : row)
    if (entry.weight > level) kept.push_back({entry.bone, entry.weight - level});
  if (kept.empty()) kept.assign(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(maximum));
  normalise(kept);
  row = std::move(kept);
  return dropped;
}

}  // namespace sunder::binding
