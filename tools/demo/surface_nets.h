#pragma once

#include <sunder/core/math.h>
#include <sunder/core/mesh.h>

#include <functional>
#include <vector>

namespace sunder::tools {

/// A closed triangle surface on shared points.
struct PointSurface {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;  ///< Counter-clockwise from outside.
};

/// Polygonises { field = 0 }; the field is negative inside, and positive on the border of the box.
///
/// Each cube that the surface crosses gets one point: the mean of the crossings on its edges, moved
/// onto the surface along the gradient. Deterministic.
/// @param cell  edge length of the grid's cubes, > 0. Features thinner than two cells may become
///              non-manifold.
/// Source: Gibson, "Constrained elastic surface nets", 1998.
PointSurface surface_nets(const std::function<double(const Vec3d&)>& field, const Vec3d& box_min,
                          const Vec3d& box_max, double cell);

/// Direction in which the field grows, unit length.
Vec3d field_normal(const std::function<double(const Vec3d&)>& field, const Vec3d& position);

}  // namespace sunder::tools
