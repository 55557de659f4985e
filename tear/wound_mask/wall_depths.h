#pragma once

#include <algorithm>
#include <queue>
#include <utility>
#include <vector>

#include "tear/wound_mask/torn_parts.h"

namespace sunder::tear {

/// How deep the walls below lips are: from a point of a lip to the farthest point of the wall that
/// is nearer to it, along the wall's edges, than to other points of lips. In bind space, metres.
class WallDepths {
 public:
  /// O(triangles of walls x log)
  explicit WallDepths(const SurfaceEditor& torn);

  /// The depth below a half-edge of the skin, the mean of its ends; 0: no wall begins there.
  [[nodiscard]] double below(Index half_edge) const;

 private:
  struct Point {
    Index point = 0;   ///< Of the surface.
    double depth = 0;  ///< Of the wall below, for one of a lip.
  };
  [[nodiscard]] std::size_t place_of(Index point) const;
  [[nodiscard]] bool has_wall(Index half_edge) const {
    const Index twin = torn_.surface().twin[half_edge];
    return twin != kNone && is_filling(twin / 3, torn_.surface()) && torn_.is_wall(twin / 3) &&
           !is_filling(half_edge / 3, torn_.surface());
  }

  const SurfaceEditor& torn_;
  std::vector<Point> points_;  ///< Of walls, ascending.
};

}  // namespace sunder::tear
