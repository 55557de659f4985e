#pragma once

#include <sunder/core/character.h>

#include <span>
#include <vector>

namespace sunder::test {

/// The points x with normal . x <= offset.
struct HalfSpace {
  Vec3d normal = Vec3d::Zero();
  double offset = 0;
};

/// The intersection of some half-spaces.
using ConvexCell = std::vector<HalfSpace>;

/// The region between two parallel planes, or inside a prism; the regions that blades and bores
/// remove are unions of these.
ConvexCell slab(const Vec3d& point, const Vec3d& normal, double half_thickness);
/// A regular polygonal prism of `sides` sides inscribed in a circle around the axis, from `origin`
/// on for `depth`.
ConvexCell prism(const Vec3d& origin, const Vec3d& direction, double radius, double depth,
                 std::uint32_t sides);

/// Area of the posed surface inside a convex cell: each triangle is clipped by itself, in double,
/// without any topology. The reference for gaps and bores. Retired triangles have no area.
double clipped_area(const Character& character, const ModelPose& pose,
                    std::span<const HalfSpace> convex_cell);

/// The same for a union of cells, by inclusion and exclusion: exponential in the number of cells
/// that overlap in one place.
double clipped_area_of_union(const Character& character, const ModelPose& pose,
                             std::span<const ConvexCell> cells);

}  // namespace sunder::test
