#pragma once

#include <sunder/core/skin.h>

#include <cmath>
#include <span>

namespace sunder {

/// The sum in double; 0 for invalid weights: none, a negative one or one that is not finite.
inline double sum_of_weights(std::span<const Influence> influences) {
  double sum = 0.0;
  for (const Influence& influence : influences) {
    if (!(influence.weight >= 0.0f) || !std::isfinite(influence.weight)) return 0.0;
    sum += static_cast<double>(influence.weight);
  }
  return sum;
}

}  // namespace sunder
