#pragma once

#include <sunder/core/math.h>

#include <cstring>

namespace sunder {

/// Compares bits, not values: 0 and -0 pose alike, and telling them apart only costs an evaluation.
inline bool has_same_bits(const Affine3d& a, const Affine3d& b) {
  return std::memcmp(a.data(), b.data(), 12 * sizeof(double)) == 0;
}

}  // namespace sunder
