#pragma once

#include <sunder/operation/operation.h>

#include <optional>

#include "tear/geometry/blade_plane.h"
#include "tear/path/surface_hit.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// Where a blade that stands still first meets the posed surface, from its base towards its tip.
[[nodiscard]] std::optional<SurfaceHit> first_hit(const Blade& blade, const SurfaceEditor& editor,
                                                  PosedPoints& posed);

/// Where the sweep of a blade first meets the posed surface at or after `progress`; among the
/// layers there, the one nearest to its base. A place from which the sweep does not go forward
/// across its triangle is passed over.
[[nodiscard]] std::optional<SurfaceHit> first_contact(const BladePlane& plane, double progress,
                                                      const SurfaceEditor& editor,
                                                      PosedPoints& posed);

/// The contact in the triangle that the first blade of a sweep meets first, which no other contact
/// comes before, unless the blade lies in faces before that triangle. Nothing where the sweep does
/// not go forward from there across it.
[[nodiscard]] std::optional<SurfaceHit> contact_at(const SurfaceHit& hit, const BladePlane& plane,
                                                   const SurfaceEditor& editor, PosedPoints& posed);

}  // namespace sunder::tear
