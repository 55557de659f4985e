#pragma once

#include <optional>
#include <vector>

#include "tear/contact/posed_surface.h"

namespace sunder::tear {

/// A place that a search found on a face.
struct FoundPlace {
  Index face = kNone;
  std::array<double, 3> barycentric = {1, 0, 0};
  double along = 0;  ///< On the ray or segment, in units of its way.
  double squared_distance = 0;
  bool enters = true;
};

/// The first face that a half-line meets: base + t way, t from 0 to `most`. Of faces at the same t
/// the first one.
[[nodiscard]] std::optional<FoundPlace> first_on_line(const Vec3d& base, const Vec3d& way,
                                                      double most, PosedSurface& surface);

/// All faces that a segment crosses, in their order along it. A crossing on an edge or a point is
/// found once per side.
/// @param found  written.
void all_on_segment(const Vec3d& base, const Vec3d& way, PosedSurface& surface,
                    std::vector<FoundPlace>& found);

/// The place nearest to a segment, within a squared distance.
[[nodiscard]] std::optional<FoundPlace> nearest_to_segment(const Vec3d& base, const Vec3d& tip,
                                                           double most_squared,
                                                           PosedSurface& surface);

/// The least squared distance of the surface from a triangle that it does not cross; infinity
/// without faces. @param most  larger ones are not searched for.
[[nodiscard]] double squared_distance_to(const Corners& triangle, double most,
                                         PosedSurface& surface);

}  // namespace sunder::tear
