#pragma once

#include <vector>

#include "tear/geometry/blade_plane.h"
#include "tear/path/entry.h"

namespace sunder::tear {

/// A run of surface edges along which the surface is to open.
struct Path {
  explicit Path(ScratchMemory& scratch) : points(&scratch), half_edges(&scratch) {}

  ScratchVector<Index> points;
  ScratchVector<Index> half_edges;  ///< Between them, where known; they may have moved since.
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
[[nodiscard]] Index imprint_point(const SurfaceHit& hit, Snapping snapping, SurfaceEditor& editor, PosedPoints& posed);

/// Makes the curve in which the plane meets the surface a run of edges: from `start` on, face to face, while it goes forward in the
/// sweep and the blade reaches it.
[[nodiscard]] Path imprint_path(const BladePlane& plane, Index start, SurfaceEditor& editor, PosedPoints& posed);

/// The next place of a path: on the far edge of a face at the point where it stands, or at an end of that edge.
struct Step {
  Index corner = kNone;  ///< Of the face, at the point where the path stands.
  double fraction = 0;   ///< Along the far edge; 0 and 1: at its ends.
  Vec3d position = Vec3d::Zero();
  double crossing_progress = 0;  ///< In the sweep, of the crossing before it snapped.
};

/// The ways in which the plane leaves a point across the faces around it, of which the path takes the one that goes forward in the
/// sweep; where several do (a fold of the surface that faces the blade), the one that bends most towards the blade's base.
[[nodiscard]] Step find_step(const BladePlane& plane, Index point, Snapping snapping, const SurfaceEditor& editor,
                             PosedPoints& posed);

/// The part of an edge at either end of which a place would be stored as that end, give or take a few units in the last place.
[[nodiscard]] double stored_part(Index half_edge, const SurfaceEditor& editor);

/// The part of an edge at either end of which a place is that end.
[[nodiscard]] double snapped_part(Index half_edge, Snapping snapping, const SurfaceEditor& editor, PosedPoints& posed);

/// How much of the way from one place to the next the blade reaches, in [0, 1].
struct Reach {
  double fraction = 1;
  bool ends_at_blade = false;
};
[[nodiscard]] Reach reach_between(const BladePlane& plane, const Vec3d& from, const Vec3d& to);

/// How far the sweep comes on the way from one place to another: at its end or, if the way leaves the sweep, about there. Farther
/// out sweep coordinates say nothing: the lines of a blade that turns meet, and on their other side they run backwards. A way that
/// leaves before the first blade has progress of minus infinity.
[[nodiscard]] double progress_towards(const BladePlane& plane, const Vec3d& from, const Vec3d& to);
/// @param reach  reach_between() them.
[[nodiscard]] double progress_towards(const BladePlane& plane, const Vec3d& from, const Vec3d& to, const Reach& reach);

/// Splits an edge and pins the new point where the posed edge has it. @return kNone where its faces cannot be split.
[[nodiscard]] Index split_posed_edge(Index half_edge, double fraction, SurfaceEditor& editor, PosedPoints& posed);

}  // namespace sunder::tear
