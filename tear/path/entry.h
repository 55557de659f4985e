#pragma once

#include <sunder/operation/operation.h>

#include <array>
#include <optional>

#include "tear/geometry/blade_plane.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// What two sweep coordinates may differ by and still be the same place: rounding of the inverse bilinear map.
inline constexpr double kSamePlace = 1e-9;

/// A place nearer to an end of an edge than this part of the edge is that end: the path moves by less than anyone can see.
inline constexpr double kSnap = 1e-3;

/// The same on edges that tears made, as a part of the longest side of the faces beside the edge: what is nearer would leave a
/// sliver. Tears have made these faces small, so the path still moves by little.
inline constexpr double kSliver = 3e-2;

/// The same at the least, where the outline of a gap has to be true: what this leaves is less than rounding shows.
inline constexpr double kTightSnap = 1e-9;

/// How far places move onto points and edges that are there.
enum class Snapping : std::uint8_t {
  by_shape,  ///< kSnap and kSliver.
  near,      ///< kSnap, where a path ends: its tip is where the blade was.
  tight,     ///< What would be stored as the same place (stored_part()), and kTightSnap.
};

/// A place on the surface.
struct SurfaceHit {
  Index triangle = kNone;
  std::array<double, 3> barycentric = {};
  Vec3d position = Vec3d::Zero();  ///< Posed.
  double progress_beyond = 0;      ///< Of a contact: where the sweep has passed that triangle.
};

/// Where a blade that stands still first meets the posed surface, from its base towards its tip.
[[nodiscard]] std::optional<SurfaceHit> first_hit(const Blade& blade, const SurfaceEditor& editor, PosedPoints& posed);

/// Where the sweep of a blade first meets the posed surface at or after `progress`; among the layers there, the one nearest to its
/// base. A place from which the sweep does not go forward across its triangle is passed over.
[[nodiscard]] std::optional<SurfaceHit> first_contact(const BladePlane& plane, double progress, const SurfaceEditor& editor,
                                                      PosedPoints& posed);

/// The contact in the triangle that the first blade of a sweep meets first, which no other contact comes before, unless the blade
/// lies in faces before that triangle. Nothing where the sweep does not go forward from there across it.
[[nodiscard]] std::optional<SurfaceHit> contact_at(const SurfaceHit& hit, const BladePlane& plane, const SurfaceEditor& editor,
                                                   PosedPoints& posed);

}  // namespace sunder::tear
