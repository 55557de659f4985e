#pragma once

#include <sunder/core/skin.h>

#include <cmath>
#include <span>

namespace sunder {

/// The sum in double; 0 for what are no weights: none at all, negative ones, ones that are not
/// finite.
inline double sum_of_weights(std::span<const Influence> influences) {
  double sum = 0.0;
  for (const Influence& influence : influences) {
    if (!(influence.weight >= 0.0f) || !std::isfinite(influence.weight)) return 0.0;
    sum += static_cast<double>(influence.weight);
  }
  return sum;
}

}  // namespace sunder
