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

/// Sorts points by their sides: each once, on the side that was reported last. Points without a
/// face are left out.
/// @param points  in the order in which they were reported; sorted on return.
/// @param rims  written; does not allocate if either side has room for all points.
void settle_rims(std::vector<RimPoint>& points, const Surface& surface, Rims& rims);

}  // namespace sunder::tear
