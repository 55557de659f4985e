#pragma once

#include "tear/geometry/blade_plane.h"
#include "tear/internal/surface.h"
#include "tear/path/surface_hit.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// The place where a plane crosses an edge, as seen from one of its faces.
struct EdgeCrossing {
  Index half_edge = kNone;
  double fraction = 0;
  Vec3d position = Vec3d::Zero();

  [[nodiscard]] SurfaceHit place() const;
  /// The same place, seen from the face across the edge.
  [[nodiscard]] EdgeCrossing from_across(const Surface& surface) const {
    return {surface.twin[half_edge], 1 - fraction, position};
  }
};

[[nodiscard]] EdgeCrossing cross_edge(const BladePlane& plane, Index half_edge,
                                      const SurfaceEditor& editor, PosedPoints& posed);

/// The place where the plane leaves a face that it entered through `half_edge`.
[[nodiscard]] EdgeCrossing find_exit(const BladePlane& plane, Index half_edge,
                                     const SurfaceEditor& editor, PosedPoints& posed);

/// The place at `fraction` of the way through a face between two of its edges.
[[nodiscard]] SurfaceHit place_between(const SurfaceHit& from, const SurfaceHit& to,
                                       double fraction);

}  // namespace sunder::tear
