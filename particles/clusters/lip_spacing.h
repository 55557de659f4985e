#pragma once

#include <algorithm>
#include <cmath>

#include "particles/internal/tolerances.h"

namespace sunder::particles {

/// How far from a lip its band reaches; all in metres.
[[nodiscard]] inline float band_depth(float range, float edge, float length) {
  return std::min(range, std::max(0.5f * length, edge));
}

/// The spacing of the small particles of a lip near its tips; all in metres.
///
/// @param range   of the decomposition.
/// @param edge    mean length of the mesh's edges.
/// @param length  of the lip between two tips; infinite if there are not two.
[[nodiscard]] inline float lip_spacing(float range, float edge, float length) {
  const float wanted = std::max(kLeastSpacingEdges * edge,
                                std::min(kLipSpacingRanges * range, length / kLeastPerLip));
  return std::isfinite(length) ? length / std::ceil(length / wanted) : wanted;
}

}  // namespace sunder::particles
