#pragma once

#include <sunder/tear/change_record.h>

#include <cstdint>
#include <span>

#include "tear/internal/surface.h"
#include "tear/surface/scratch_memory.h"

namespace sunder::tear {

/// A point on one side of a gap.
struct RimPoint {
  Index point = kNone;
  bool is_left = false;
};

/// Rim points by ascending index, those of one point in the order in which they were reported.
/// @return per entry: the point, its place in the order, and whether it is left, as one number.
[[nodiscard]] ScratchVector<std::uint64_t> sort_rim_points(std::span<const RimPoint> points,
                                                           ScratchMemory& memory);

/// Sorts points by their sides: each once, on the side that was reported last. Points without a
/// face are left out.
/// @param sorted  of sort_rim_points().
/// @param rims  written; does not allocate if either side has room for all points.
void settle_rims(std::span<const std::uint64_t> sorted, const Surface& surface, Rims& rims);

}  // namespace sunder::tear
