#pragma once

#include <sunder/bodies/convex_hulls.h>

namespace sunder::bodies {

/// The hull of finite points, at least one. Needs Qhull. @throws std::bad_alloc
[[nodiscard]] ConvexHull hull_of_points(std::span<const Vec3d> points,
                                        std::uint32_t maximum_points);

}  // namespace sunder::bodies
