#pragma once

#include <sunder/core/index.h>

#include <span>
#include <vector>

namespace sunder::validation {

/// A bone's share in a point.
struct BoneWeight {
  Index bone = 0;
  double weight = 0;
};

/// The weights of a point, each bone once, by ascending bone.
using WeightRow = std::vector<BoneWeight>;

/// Adds `part` times another row.
void add(WeightRow& row, double part, const WeightRow& other);

[[nodiscard]] double sum_of(const WeightRow& row);

/// Sum over bones of |a - b|.
[[nodiscard]] double distance(const WeightRow& a, const WeightRow& b);

/// Divides by the sum. @return false if the sum is not positive; the row is unchanged then.
bool normalise(WeightRow& row);

/// Keeps the `maximum` largest weights (of equal ones the smaller bones) and normalises them.
void limit(WeightRow& row, std::size_t maximum);

}  // namespace sunder::validation
