#pragma once

#include <sunder/operation/operation.h>

#include <optional>

#include "tear/geometry/blade_plane.h"
#include "tear/path/surface_hit.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// The first place where a blade that does not move meets the posed surface, from its base towards
/// its tip.
[[nodiscard]] std::optional<SurfaceHit> first_hit(const Blade& blade, const SurfaceEditor& editor,
                                                  PosedPoints& posed);

/// The faces that a search for contacts looks at.
enum class ContactWith : std::uint8_t { all_faces, all_but_walls };

/// The first place, at or after `progress`, where the sweep of a blade meets the posed surface. If
/// several layers are met there, the one nearest to the blade's base. Places from which the sweep
/// does not go forward across their triangle are skipped.
[[nodiscard]] std::optional<SurfaceHit> first_contact(const BladePlane& plane, double progress,
                                                      const SurfaceEditor& editor,
                                                      PosedPoints& posed,
                                                      ContactWith with = ContactWith::all_faces);

/// The first place in a triangle, at or after `progress`, as first_contact() finds it.
[[nodiscard]] std::optional<SurfaceHit> contact_in(Index triangle, const BladePlane& plane,
                                                   double progress, const SurfaceEditor& editor,
                                                   PosedPoints& posed);

/// The contact in the triangle that the first blade of a sweep meets. No other contact comes
/// before it, unless the blade lies in faces before that triangle. Empty if the sweep does not go
/// forward from there across the triangle.
[[nodiscard]] std::optional<SurfaceHit> contact_at(const SurfaceHit& hit, const BladePlane& plane,
                                                   const SurfaceEditor& editor, PosedPoints& posed);

}  // namespace sunder::tear
