#pragma once

#include <span>
#include <vector>

#include "tear/section/flat_section.h"

namespace sunder::test {

/// The points of a triangulated region, as triangulate() numbers them.
std::vector<Vec2d> all_points(std::span<const tear::FlatLoop> loops, const tear::FlatRegion& region,
                              const tear::FlatMesh& mesh);
/// The number of those on the loops.
Index rim_count(std::span<const tear::FlatLoop> loops, const tear::FlatRegion& region);

// Expectations of a test.

/// The guarantees in the header of triangulate().
void expect_constrained_delaunay(std::span<const tear::FlatLoop> loops,
                                 const tear::FlatRegion& region, const tear::FlatMesh& mesh);
/// Inner points are not closer to any point than the closest neighbours on the rim.
void expect_inner_points_in_place(std::span<const tear::FlatLoop> loops,
                                  const tear::FlatRegion& region, const tear::FlatMesh& mesh);

}  // namespace sunder::test
