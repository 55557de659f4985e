#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::test {

/// Distances from a point along the edges of a surface.
std::vector<double> edge_distances(const tear::Surface& surface, std::span<const Vec3f> positions,
                                   std::uint32_t source);

/// Distances from a point along straight lines within faces, from any of `steps` places on an edge
/// to any other: never shorter than the shortest path, and hardly longer. Retired triangles must be
/// left out of the surface.
std::vector<double> fine_distances(const tear::Surface& surface, std::span<const Vec3f> positions,
                                   std::uint32_t source, std::uint32_t steps = 6);

/// Places of a surface's points in bind space, of whatever vertex they have.
std::vector<Vec3f> bind_positions(const Character& character, const tear::Surface& surface);

}  // namespace sunder::test
