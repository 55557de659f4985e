#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Follows an operation, or an extension of the current stroke. O(faces torn).
void follow_operation(const TornModel& model, Structure& structure,
                      std::span<const ChangeRecord> changes);

/// Continues the work that operations left, for at most the given number of points.
void settle_band(const TornModel& model, Structure& structure, Index points);

}  // namespace sunder::particles
