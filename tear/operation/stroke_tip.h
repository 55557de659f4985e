#pragma once

#include <optional>

#include "tear/geometry/blade_plane.h"
#include "tear/path/entry.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// The place where a tear stands between two segments of its stroke.
struct StrokeTip {
  Index point = kNone;    ///< kNone while the tear does not stand on the surface.
  bool ends_run = false;  ///< Whether torn surface ends there; not if nothing was torn yet.
  /// Where the blade meets the surface at the beginning of the segment, until find_contact() uses
  /// it.
  std::optional<SurfaceHit> hit;

  /// Whether the tear ends in a point that still has a face.
  [[nodiscard]] bool is_on_surface(const Workpiece& work) const;
};

/// Finds where the sweep of a segment next meets the surface, from `progress` on.
[[nodiscard]] std::optional<SurfaceHit> find_contact(const BladePlane& plane, double progress,
                                                     const Workpiece& work, StrokeTip& tip);

}  // namespace sunder::tear
