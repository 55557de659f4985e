#pragma once

#include "tear/section/flat_section.h"
#include "tear/surface/scratch_memory.h"

namespace sunder::tear {

// The triangulation takes no loops that touch or cross themselves, but rims may do so where they
// pass a point several times, or by rounding. Their points are moved a little before.

/// An order of places, from left to right.
[[nodiscard]] inline bool is_left_of(const Vec2d& a, const Vec2d& b) {
  return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
}

/// Where a loop passes a place several times, moves each of its points there into the section, on
/// the left of the loop, by a tiny part of the edges there: the triangulation takes no loops that
/// touch themselves.
void part_touching_points(FlatLoop& loop, ScratchMemory& scratch);

/// Where consecutive points of a loop are closer than `close`, moves them apart along the edges
/// before and after them: rounding may have exchanged such points, and then the loop crosses itself
/// there. @return whether there are any.
bool part_close_points(FlatLoop& loop, double close);

}  // namespace sunder::tear
