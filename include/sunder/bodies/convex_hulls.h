#pragma once

#include <sunder/core/character.h>

#include <cstdint>
#include <span>
#include <vector>

namespace sunder {

struct HullOptions {
  /// Most hulls. Parts of a surface that different bones move get a hull each; the smallest join a
  /// neighbour until there are no more than this. >= 1.
  std::uint32_t maximum_hulls = 8;
  /// Most points per hull, 4 to 65,535: many engines take at most 32, 64 or 255. Of more points
  /// those stay that are farthest out.
  std::uint32_t maximum_points = 64;
};

/// A convex polyhedron. The hull of points in a plane has no volume and both sides of the plane as
/// faces; that of points on a line has no faces.
struct ConvexHull {
  std::vector<Vec3d> points;        ///< Some of the given ones, bit for bit.
  std::vector<Triangle> triangles;  ///< Of `points`, counter-clockwise from outside.
  std::uint32_t part = kNone;  ///< Number of the part, such as a bone; of several, the largest.
  double volume = 0.0;         ///< Cubic metres.
  /// No given point is farther outside than this, metres. 0 within rounding unless maximum_points
  /// left points out.
  double farthest_outside = 0.0;
};

/// Whether the library was built with Qhull (SUNDER_QHULL).
[[nodiscard]] SUNDER_API bool has_convex_hulls();

/// The hull of points. @param maximum_points  as HullOptions.
/// @return unsupported_feature without Qhull; empty_input; non_finite_value with the point;
///         invalid_argument for the limit; limit_exceeded (out of memory). O(n log n), and
///         O(limit^2 log limit) if it leaves points out; allocates. Deterministic.
/// Source: Barber, Dobkin, Huhdanpaa 1996 [barber1996quickhull].
[[nodiscard]] SUNDER_API Result<ConvexHull> convex_hull(std::span<const Vec3d> points,
                                                        std::uint32_t maximum_points = 64);

/// The hulls of the parts of a surface. @param part_of_triangle  one per triangle, any numbers;
/// retired triangles are skipped. @return as convex_hull(), ascending by part; size_mismatch,
/// index_out_of_range with the triangle.
[[nodiscard]] SUNDER_API Result<std::vector<ConvexHull>> convex_hulls(
    std::span<const Vec3d> positions, std::span<const Triangle> triangles,
    std::span<const std::uint32_t> part_of_triangle, const HullOptions& options = {});

/// The hulls of a character in a pose, in model space; the parts are the bones that move triangles
/// most. @return as above; the failures of the pose.
[[nodiscard]] SUNDER_API Result<std::vector<ConvexHull>> convex_hulls(
    const Character& character, const ModelPose& pose, const HullOptions& options = {});

/// The bone of the skeleton that moves a triangle most: of the greatest sum of weights over the
/// three corners, the first of several. @param weights  of the vertices of the triangle; unchecked.
[[nodiscard]] SUNDER_API std::uint32_t main_bone(const Triangle& triangle,
                                                 const SkinWeights& weights, const Skin& skin);

}  // namespace sunder
