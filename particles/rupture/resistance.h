#pragma once

#include <algorithm>
#include <numbers>

#include "particles/rupture/tissue.h"

namespace sunder::particles {

/// The energy that a tear takes per length, J/m; 0: it never runs on. Without a toughness it is
/// that at which a slit as long as the material's flaws runs on at its strength: pi S e^2 / 4 per
/// length of the slit, for a strain e of a wide membrane around it.
[[nodiscard]] inline double toughness_of(const SoftMaterial& material) {
  if (material.toughness > 0 || !(material.strength > 0)) return material.toughness;
  const double strain = material.strength - 1;
  return std::numbers::pi / 4 * material.membrane_stiffness * strain * strain *
         material.flaw_length;
}

/// Between two materials: the lower one of those that tear.
[[nodiscard]] inline double toughness_between(const SoftMaterial& a, const SoftMaterial& b) {
  const double of_a = toughness_of(a), of_b = toughness_of(b);
  return of_a == 0 || of_b == 0 ? std::max(of_a, of_b) : std::min(of_a, of_b);
}

}  // namespace sunder::particles
