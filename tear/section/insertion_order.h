#pragma once

#include <sunder/core/math.h>

#include <span>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// The order in which to insert points into a Delaunay triangulation: biased random rounds, each
/// along Hilbert's curve, so that neither the search for a point nor what it changes is long
/// (Amenta, Choi, Rote 2003). The dice are the points' indices: the same points come in the same
/// order. At least one point.
[[nodiscard]] std::vector<Index> insertion_order(std::span<const Vec2d> points);

}  // namespace sunder::tear
