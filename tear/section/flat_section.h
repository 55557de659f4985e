#pragma once

#include <sunder/core/math.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

// Flat regions between closed polygons: the caps of a body that a plane cuts. Nothing here knows of
// meshes. Whatever the input is, all decisions are exact (exact_predicates.h) and the result is the
// same bits on every compiler.

/// A closed polygon in the plane; the last point joins the first.
using FlatLoop = std::vector<Vec2d>;

/// Loops that bound one connected flat region. Indices of loops.
struct FlatRegion {
  Index outline = 0;
  std::vector<Index> holes;  ///< Ascending.
};

/// Nests loops: outline, hole, island in a hole, and so on. A loop is a hole where it runs against
/// the outermost one around it, so that of two bodies one in the other each has a region of its
/// own. Regions come in the order of their outlines.
///
/// Loops that run around no area (fewer than three points, all on one line, to and fro) or are not
/// finite are in no region. Where loops cross, touch or coincide every other loop is still in
/// exactly one region, but triangulate() may refuse that. O(loops^2 + loops * points), of which a
/// loop pays for those only whose bounding box it is in.
[[nodiscard]] std::vector<FlatRegion> find_regions(std::span<const FlatLoop> loops);

/// Triangles of a region. Points are numbered: those of its loops one after another, the outline
/// first, then the holes in the order given, then `inner`.
struct FlatMesh {
  std::vector<Vec2d> inner;
  std::vector<std::array<Index, 3>> triangles;  ///< Counter-clockwise, none without area (exactly).
};

/// Constrained Delaunay triangulation of a region, with inner points where it is wide so that it
/// bends well.
///
/// Every loop edge is an edge of exactly one triangle and every other edge of two; no point is put
/// on a loop. The areas of the triangles add up to that of the outline less those of the holes,
/// within rounding. For a region with n points on h holes that is n + 2 h - 2 triangles, and two
/// more for each inner point.
///
/// @param spacing  between inner points, which stand in equilateral triangles, none nearer to the
/// rim than half of it; it is
///                 enlarged until there are at most 4 n + 64 of them. None where it is not above
///                 zero or not finite.
/// @return nothing where no such triangulation exists: loops that cross or touch one another or
/// themselves, be it in one point;
///         repeated points; all points on one line; holes that are not in the outline; coordinates
///         that are not finite or beyond 2^200. Coordinates below 2^-200 are taken for zero.
///
/// Expected O(n log n) for points as they come from surfaces; 10,000 rim points take some tens of
/// milliseconds.
[[nodiscard]] std::optional<FlatMesh> triangulate(std::span<const FlatLoop> loops,
                                                  const FlatRegion& region, double spacing);

/// Harmonic extension of values on the rim (Dirichlet) to the inner points, by the cotangent
/// Laplacian. On a Delaunay triangulation its weights are not negative, so that every result is a
/// convex combination of the rim's values, and linear functions are reproduced. Source: Pinkall and
/// Polthier 1993.
///
/// @param points      those of the rim, then the inner ones, as triangulate() numbers them.
/// @param triangles   of triangulate().
/// @param rim_values  one row a rim point, one column a channel.
/// @return one row an inner point. Each channel stays within the least and the greatest of its rim
/// values, exactly. Otherwise
///         accurate to about 1e-10 of that range: channels that add up to one do so to that
///         accuracy.
[[nodiscard]] Eigen::MatrixXd extend_harmonically(std::span<const Vec2d> points, Index rim_count,
                                                  std::span<const std::array<Index, 3>> triangles,
                                                  const Eigen::MatrixXd& rim_values);

}  // namespace sunder::tear
