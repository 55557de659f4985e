#pragma once

#include <sunder/tear/change_record.h>

#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// A point on one side of a gap.
struct RimPoint {
  Index point = kNone;
  bool is_left = false;
};

/// Sorts points by their sides: each once, on the side that was told last, and without those that
/// have no face any more.
/// @param points  in the order in which they were told; sorted. @param rims  written; does not
/// allocate where it has room for all on either side.
void settle_rims(std::vector<RimPoint>& points, const Surface& surface, Rims& rims);

}  // namespace sunder::tear
