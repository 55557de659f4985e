#pragma once

#include <cstddef>
#include <memory_resource>
#include <span>

#include "tear/section/constrained_delaunay.h"

namespace sunder::tear {

/// The number of inner points that `rim_points` points get at most.
[[nodiscard]] constexpr std::size_t most_graded_points(std::size_t rim_points) {
  return 2 * rim_points + 64;
}

/// Inserts points inside a triangulation of a rim until no triangle is large for its place: where
/// the circle of a triangle is larger than the size asked for, its centre is inserted (Ruppert
/// 1995, without points on the rim); then the points are smoothed. At the rim the size is the
/// length of its longer edges. The size grows with the distance from the rim. A short edge between
/// long ones, as where a plane passes a vertex, gets a few points in front of it, farther from one
/// another step by step.
/// @param loop_ends  the points of the triangulation are those of closed loops, one after the
///                   other, each up to one of these.
void add_graded_points(std::span<const Index> loop_ends, ConstrainedDelaunay& triangulation,
                       std::pmr::memory_resource& memory);

}  // namespace sunder::tear
