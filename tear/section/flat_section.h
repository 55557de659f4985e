#pragma once

#include <sunder/core/math.h>

#include <array>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

// Flat regions between closed polygons: the caps of a body cut by a plane. Independent of meshes.
// All decisions are exact for any input (exact_predicates.h), and the bits of the result do not
// depend on the compiler. Results and temporary data lie in the given memory.

/// A closed polygon in the plane; the last point connects to the first.
using FlatLoop = std::pmr::vector<Vec2d>;

/// The loops that bound one connected flat region, by index.
struct FlatRegion {
  Index outline = 0;
  std::pmr::vector<Index> holes;  ///< Ascending.
};

/// Nests loops into outlines, holes, islands in holes, and so on. A loop is a hole if its direction
/// is opposite to the outermost loop around it, so that two bodies, one inside the other, each have
/// a region. Regions are ordered by their outlines.
///
/// Loops without area (fewer than three points, collinear, to and fro) or with non-finite points
/// are in no region. If loops cross, touch or coincide, every other loop is still in exactly one
/// region, but triangulate() may refuse it. O(loops^2 + loops x points); only loops inside the
/// bounding box of another one cost the second term.
[[nodiscard]] std::pmr::vector<FlatRegion> find_regions(
    std::span<const FlatLoop> loops,
    std::pmr::memory_resource& memory = *std::pmr::get_default_resource());

/// The triangles of a region. Points are numbered: those of its loops, the outline first, then the
/// holes in the given order, then `inner`.
struct FlatMesh {
  explicit FlatMesh(std::pmr::memory_resource& memory)
      : inner(&memory), triangles(&memory), twins(&memory) {}

  std::pmr::vector<Vec2d> inner;
  /// Counter-clockwise, with an area that is exactly positive.
  std::pmr::vector<std::array<Index, 3>> triangles;
  /// Per edge k of triangle t, from corner k to the next one, as 3 t + k: the same edge of the
  /// other triangle; kNone on a loop.
  std::pmr::vector<Index> twins;
};

enum class InnerPoints : std::uint8_t {
  none,
  graded,  ///< As close as the points of the rim near it, and sparser inwards.
};

/// Constrained Delaunay triangulation of a region, with inner points where it is wide, so that it
/// bends well. Every loop edge is an edge of exactly one triangle, every other edge of two; no
/// point is added on a loop. The areas add up to that of the outline minus those of the holes,
/// within rounding. n points on h holes give n + 2 h - 2 triangles, and two more per inner point,
/// of which there are at most 4 n + 64; see add_graded_points().
/// @return nullopt if there is no such triangulation: loops that touch or cross; repeated points;
/// all points collinear; holes outside the outline; coordinates not finite or beyond 2^200 (below
/// 2^-200 they count as zero). Expected O(n log n).
[[nodiscard]] std::optional<FlatMesh> triangulate(
    std::span<const FlatLoop> loops, const FlatRegion& region, InnerPoints inner,
    std::pmr::memory_resource& memory = *std::pmr::get_default_resource());

/// Extends values on the rim harmonically (Dirichlet) to the inner points, by the cotangent
/// Laplacian. On a Delaunay triangulation its weights are not negative, so every result is a convex
/// combination of the rim's values, and linear functions are reproduced. Source: Pinkall and
/// Polthier 1993.
///
/// @param points  those of the rim, then the inner ones, as numbered by triangulate().
/// @param values  one row of `channels` per point: those of the rim are read, the others written.
/// Each channel stays exactly within the range of its rim values, and is accurate to about 1e-10 of
/// that range; so channels that add up to one still do.
void extend_harmonically(std::span<const Vec2d> points, const FlatMesh& mesh, std::size_t channels,
                         std::span<double> values,
                         std::pmr::memory_resource& memory = *std::pmr::get_default_resource());

}  // namespace sunder::tear
