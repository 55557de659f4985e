#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Follows an operation, or an extension of the stroke under way. O(faces torn).
void follow_operation(const TornModel& model, Structure& structure,
                      std::span<const ChangeRecord> changes);

/// Goes on with the band that the last operation left, for at most so many points, or to its end.
void settle_band(const TornModel& model, Structure& structure, Index points);
void complete_band(const TornModel& model, Structure& structure);

}  // namespace sunder::particles
