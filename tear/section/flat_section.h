#pragma once

#include <sunder/core/math.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

// Flat regions between closed polygons: the caps of a body cut by a plane. Independent of meshes.
// All decisions are exact for any input (exact_predicates.h), and the bits of the result do not
// depend on the compiler.

/// A closed polygon in the plane; the last point connects to the first.
using FlatLoop = std::vector<Vec2d>;

/// The loops that bound one connected flat region, by index.
struct FlatRegion {
  Index outline = 0;
  std::vector<Index> holes;  ///< Ascending.
};

/// Nests loops into outlines, holes, islands in holes, and so on. A loop is a hole if its direction
/// is opposite to the outermost loop around it, so that two bodies, one inside the other, each have
/// a region. Regions are ordered by their outlines.
///
/// Loops without area (fewer than three points, collinear, to and fro) or with non-finite points
/// are in no region. If loops cross, touch or coincide, every other loop is still in exactly one
/// region, but triangulate() may refuse it. O(loops^2 + loops x points); only loops inside the
/// bounding box of another one cost the second term.
[[nodiscard]] std::vector<FlatRegion> find_regions(std::span<const FlatLoop> loops);

/// The triangles of a region. Points are numbered: those of its loops, the outline first, then the
/// holes in the given order, then `inner`.
struct FlatMesh {
  std::vector<Vec2d> inner;
  /// Counter-clockwise, with an area that is exactly positive.
  std::vector<std::array<Index, 3>> triangles;
};

/// Constrained Delaunay triangulation of a region, with inner points where it is wide, so that it
/// bends well. Every loop edge is an edge of exactly one triangle, every other edge of two; no
/// point is added on a loop. The areas add up to that of the outline minus those of the holes,
/// within rounding. n points on h holes give n + 2 h - 2 triangles, and two more per inner point.
///
/// @param spacing  distance of inner points, in a grid of equilateral triangles, at least half of
///         it from the rim. It is enlarged until there are at most 4 n + 64. No inner points unless
///         finite and > 0.
/// @return nullopt if there is no such triangulation: loops that touch or cross; repeated points;
/// all points collinear; holes outside the outline; coordinates not finite or beyond 2^200 (below
/// 2^-200 they count as zero). Expected O(n log n); 10,000 rim points take some tens of ms.
[[nodiscard]] std::optional<FlatMesh> triangulate(std::span<const FlatLoop> loops,
                                                  const FlatRegion& region, double spacing);

/// Extends values on the rim harmonically (Dirichlet) to the inner points, by the cotangent
/// Laplacian. On a Delaunay triangulation its weights are not negative, so every result is a convex
/// combination of the rim's values, and linear functions are reproduced. Source: Pinkall and
/// Polthier 1993.
///
/// @param points      those of the rim, then the inner ones, as numbered by triangulate().
/// @param rim_values  one row per rim point, one column per channel.
/// @return one row per inner point. Each channel stays exactly within the range of its rim values,
/// and is accurate to about 1e-10 of that range; so channels that add up to one still do.
[[nodiscard]] Eigen::MatrixXd extend_harmonically(std::span<const Vec2d> points, Index rim_count,
                                                  std::span<const std::array<Index, 3>> triangles,
                                                  const Eigen::MatrixXd& rim_values);

}  // namespace sunder::tear
