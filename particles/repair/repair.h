#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Follows an operation, or an extension of the current stroke. O(faces torn).
void follow_operation(const TornModel& model, Structure& structure,
                      std::span<const ChangeRecord> changes);

/// Continues the band that the last operation left, for at most the given number of points, or to
/// its end.
void settle_band(const TornModel& model, Structure& structure, Index points);
void complete_band(const TornModel& model, Structure& structure);

}  // namespace sunder::particles
