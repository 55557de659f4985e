#pragma once

#include "tear/geometry/blade_plane.h"
#include "tear/path/snapping.h"

namespace sunder::tear {

/// The reason why a curve in which a blade's plane meets the surface ends.
enum class PathEnd : std::uint8_t {
  blade,    ///< It reached the second blade: the next segment continues from here.
  surface,  ///< A border, a fold away from the blade, or the end of the blade's reach.
  blocked,  ///< A face that cannot be split.
};

/// The fraction of the way from one place to another that the blade reaches, in [0, 1].
struct Reach {
  double fraction = 1;
  bool ends_at_blade = false;

  [[nodiscard]] bool is_whole() const { return fraction == 1 && !ends_at_blade; }
  /// How a curve ends that the blade reaches no farther.
  [[nodiscard]] PathEnd end() const { return ends_at_blade ? PathEnd::blade : PathEnd::surface; }
};
[[nodiscard]] Reach reach_between(const BladePlane& plane, const Vec3d& from, const Vec3d& to);

/// Progress in the sweep at the end of the way from one place to another or, if the way leaves the
/// sweep, about where it leaves. Farther out sweep coordinates mean nothing: the lines of a turning
/// blade meet, and beyond that they run backwards. Minus infinity for a way that leaves before the
/// first blade.
[[nodiscard]] double progress_towards(const BladePlane& plane, const Vec3d& from, const Vec3d& to);
/// @param reach  reach_between() them.
[[nodiscard]] double progress_towards(const BladePlane& plane, const Vec3d& from, const Vec3d& to,
                                      const Reach& reach);

/// The next place of a curve: on the far edge of a face at the current point, or at an end of it.
struct Step {
  Index corner = kNone;  ///< The face's corner at the current point.
  double fraction = 0;   ///< Along the far edge; 0 and 1 at its ends.
  Vec3d position = Vec3d::Zero();
  double crossing_progress = 0;  ///< Progress in the sweep of the crossing before it snapped.

  /// The corner of the face that the step goes to; kNone if it goes into the far edge.
  [[nodiscard]] Index end_corner() const;
};

/// Finds the step that goes forward in the sweep across the faces around a point. If several do (a
/// fold that faces the blade), the one that bends most towards the blade's base.
/// @return a step without a corner if none goes forward.
[[nodiscard]] Step find_step(const BladePlane& plane, Index point, Snapping snapping,
                             const SurfaceEditor& editor, PosedPoints& posed);

}  // namespace sunder::tear
