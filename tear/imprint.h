#pragma once

#include <vector>

#include "tear/blade_plane.h"
#include "tear/entry.h"

namespace sunder::tear {

/// A run of surface edges along which the surface is to open.
struct Path {
  std::vector<Index> points;
  Index faces_crossed = 0;
  double length_posed = 0;
  double progress = 0;  ///< In the sweep, of the end of the curve.
  enum class End : std::uint8_t {
    blade,    ///< Reached the second blade: the next segment goes on from here.
    surface,  ///< A border, a fold away from the blade, or the end of its reach.
    blocked,  ///< A face that cannot be split.
  };
  End end = End::surface;
};

/// Makes a place on the surface a point of it: an existing one where the place is near it, else by splitting an edge or a face.
/// @return kNone where the faces are too small or degenerate for that.
[[nodiscard]] Index imprint_point(const SurfaceHit& hit, SurfaceEditor& editor, PosedPoints& posed);

/// Makes the curve in which the plane meets the surface a run of edges: from `start` on, face to face, while it goes forward in the
/// sweep and the blade reaches it.
[[nodiscard]] Path imprint_path(const BladePlane& plane, Index start, SurfaceEditor& editor, PosedPoints& posed);

/// Puts a point into the middle of an edge. @return kNone where its faces cannot be split.
[[nodiscard]] Index imprint_midpoint(Index half_edge, SurfaceEditor& editor, PosedPoints& posed);

}  // namespace sunder::tear
