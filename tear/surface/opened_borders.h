#pragma once

#include <algorithm>
#include <vector>

#include "tear/surface/gap_rims.h"

namespace sunder::tear {

/// The borders that a call or an operation opened, as change records report them.
struct OpenedBorders {
  std::vector<LipPair> lips;
  std::vector<RimPoint> rim_points;  ///< In the order in which cells were removed.

  void clear() {
    lips.clear();
    rim_points.clear();
  }
};

/// Reserves memory for `size` values. An array that has to grow at least doubles.
template <class T>
void make_room_to_hold(std::size_t size, std::vector<T>& values) {
  if (size > values.capacity()) values.reserve(std::max(size, 2 * values.capacity()));
}

}  // namespace sunder::tear
