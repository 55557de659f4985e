#pragma once

#include <sunder/core/math.h>

#include <memory_resource>
#include <span>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// The order in which points are inserted into a Delaunay triangulation: biased random rounds, each
/// along a Hilbert curve, so that both the search for a point and its cavity are short (Amenta,
/// Choi, Rote 2003). The random numbers depend on the indices alone, so the order is deterministic.
/// At least one point.
[[nodiscard]] std::pmr::vector<Index> insertion_order(std::span<const Vec2d> points,
                                                      std::pmr::memory_resource& memory);

}  // namespace sunder::tear
