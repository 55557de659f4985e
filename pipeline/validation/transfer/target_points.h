#pragma once

#include <span>
#include <vector>

#include "pipeline/validation/internal/weight_row.h"
#include "pipeline/validation/match/surface_match.h"

namespace sunder::validation {

/// The points of a target that are solved once each. They are numbered by their places, so that
/// nothing depends on the order of the vertices.
struct TargetPoints {
  std::vector<Index> point_of_vertex;
  std::vector<Index> first_vertex;  ///< Per point: a vertex of it.
  std::vector<Vec3d> positions;     ///< Per point.
  std::vector<Triangle> triangles;  ///< Of points; only those with an area and three points.

  [[nodiscard]] Index count() const { return static_cast<Index>(positions.size()); }
};

/// Welds the vertices of a target. Vertices at one place whose matches were accepted at places with
/// different weights stay apart, because the source is parted there.
/// @param rows  the weights at the match of each vertex.
[[nodiscard]] TargetPoints make_points(const BindSurface& target,
                                       std::span<const SurfaceMatch> matches,
                                       std::span<const WeightRow> rows);

/// The connected part of each element: sets of elements joined by triangles, numbered by their
/// smallest element.
struct Parts {
  std::vector<Index> of;  ///< Per element.
  Index count = 0;
};
[[nodiscard]] Parts find_parts(std::size_t elements, std::span<const Triangle> triangles);

}  // namespace sunder::validation
