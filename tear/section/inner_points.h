#pragma once

#include <sunder/core/math.h>

#include <array>
#include <span>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// Points of a grid of equilateral triangles inside closed polygons (even-odd rule), at least half
/// of `spacing` away from them.
///
/// @param edges    pairs of points that form closed polygons.
/// @param area     approximate area of the region, for a first guess of the spacing.
/// @param spacing  > 0; enlarged until there are at most `capacity` points.
/// Not exact: a point may be on the wrong side of polygon edges that are closer together than
/// rounding can tell.
[[nodiscard]] std::vector<Vec2d> place_inner_points(std::span<const Vec2d> points,
                                                    std::span<const std::array<Index, 2>> edges,
                                                    double area, double spacing,
                                                    std::size_t capacity);

}  // namespace sunder::tear
