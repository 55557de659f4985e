#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::test {

/// Distances from a point along the edges of a surface.
std::vector<double> edge_distances(const tear::Surface& surface, std::span<const Vec3f> positions,
                                   std::uint32_t source);

/// Distances from a point along straight lines within faces, between any of `steps` places on each
/// edge: never shorter than the shortest path, and hardly longer. The surface must not contain
/// retired triangles.
std::vector<double> fine_distances(const tear::Surface& surface, std::span<const Vec3f> positions,
                                   std::uint32_t source, std::uint32_t steps = 6);

/// Positions of a surface's points in bind space, from any of their vertices.
std::vector<Vec3f> bind_positions(const Character& character, const tear::Surface& surface);

}  // namespace sunder::test
