#pragma once

#include <vector>

#include "pipeline/binding/joined.h"

namespace sunder::binding {

/// The surface of a model, all meshes as one, with the vertices at one place and of one tear side
/// joined to a point. Points are numbered by their places and triangles by their points, so that
/// nothing depends on the order of the file.
struct WeldedSurface {
  std::vector<std::vector<Index>> point_of_vertex;  ///< Per mesh and vertex.
  std::vector<Vec3d> positions;                     ///< Per point, rig space.
  std::vector<Triangle> triangles;                  ///< Of three different points.
  std::vector<bool> has_area;                       ///< Per triangle.
  std::vector<Index> part_of_point;                 ///< Connected part; kNone without a triangle.
  Index part_count = 0;
  /// Per part: whether each edge has two faces that agree on their outer side, so that the part has
  /// an inside.
  std::vector<bool> is_closed;
  double diagonal = 0;  ///< Of the box around all points.

  [[nodiscard]] Index point_count() const { return static_cast<Index>(positions.size()); }
};

[[nodiscard]] WeldedSurface weld(const Joined& joined);

}  // namespace sunder::binding
