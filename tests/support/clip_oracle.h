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

/// The points in all of some half-spaces.
using ConvexCell = std::vector<HalfSpace>;

/// Between two parallel planes, or inside of a prism: what blades and bores remove, put together
/// from such.
ConvexCell slab(const Vec3d& point, const Vec3d& normal, double half_thickness);
/// The regular polygon of `sides` corners on a circle around the axis, from `origin` on for
/// `depth`.
ConvexCell prism(const Vec3d& origin, const Vec3d& direction, double radius, double depth,
                 std::uint32_t sides);

/// Area of the posed surface inside a convex cell: each triangle clipped on its own, in double,
/// without any topology. The measure that gaps and bores are held against. Retired triangles have
/// no area.
double clipped_area(const Character& character, const ModelPose& pose,
                    std::span<const HalfSpace> convex_cell);

/// The same for a union of cells, by inclusion and exclusion: exponential in the number of cells
/// that meet in one place.
double clipped_area_of_union(const Character& character, const ModelPose& pose,
                             std::span<const ConvexCell> cells);

}  // namespace sunder::test
