#pragma once

#include <sunder/particles/collider.h>

#include <array>
#include <cstdint>
#include <vector>

namespace sunder::particles {

/// Points, and the triangles between some of them.
struct PartOfBone {
  std::vector<Vec3d> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices in `points`.
};

/// Fitted shapes, or boxes along the frame, that together hold all points and triangles, each
/// triangle within one of them: from one shape on, that one is cut in two, across an axis of it or
/// of the frame, where this takes most off the volume of all, as long as it takes a twentieth.
/// @param part  at least one point.
/// @param most  of the shapes; at least 1.
[[nodiscard]] std::vector<Collider> split_shapes(const PartOfBone& part, double friction,
                                                 std::uint32_t most);

}  // namespace sunder::particles
