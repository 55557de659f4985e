#include "pipeline/validation/internal/weight_row.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sunder::validation {
namespace {

/// Calls visit(bone, weight in a, weight in b) for the bones of either row, ascending.
template <class Visit>
void for_each_bone(const WeightRow& a, const WeightRow& b, const Visit& visit) {
  for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    if (j == b.size() || (i < a.size() && a[i].bone < b[j].bone)) {
      visit(a[i].bone, a[i].weight, 0.0);
      ++i;
    } else if (i == a.size() || b[j].bone < a[i].bone) {
      visit(b[j].bone, 0.0, b[j].weight);
      ++j;
    } else {
      visit(a[i].bone, a[i].weight, b[j].weight);
      ++i, ++j;
    }
  }
}

}  // namespace

void add(WeightRow& row, double part, const WeightRow& other) {
  WeightRow sum;
  sum.reserve(row.size() + other.size());
  for_each_bone(row, other, [&](Index bone, double own, double added) {
    sum.push_back({bone, own + part * added});
  });
  row = std::move(sum);
}

double sum_of(const WeightRow& row) {
  double sum = 0;
  for (const BoneWeight& entry : row) sum += entry.weight;
  return sum;
}

double distance(const WeightRow& a, const WeightRow& b) {
  double sum = 0;
  for_each_bone(a, b, [&](Index, double of_a, double of_b) { sum += std::abs(of_a - of_b); });
  return sum;
}

bool normalise(WeightRow& row) {
  const double sum = sum_of(row);
  if (!(sum > 0)) return false;
  for (BoneWeight& entry : row) entry.weight /= sum;
  return true;
}

void limit(WeightRow& row, std::size_t maximum) {
  if (row.size() <= maximum) return;
  std::ranges::sort(row, [](const BoneWeight& a, const BoneWeight& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.bone < b.bone;
  });
  row.resize(maximum);
  std::ranges::sort(row, {}, &BoneWeight::bone);
  normalise(row);
}

}  // namespace sunder::validation
