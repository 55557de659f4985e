#pragma once

#include <sunder/core/index.h>

#include <array>
#include <cstddef>
#include <vector>

#include "tear/surface/append_filling.h"

namespace sunder::tear {

/// The walls that a stroke got so far. A plain value, so that a failing call can go back to a copy.
struct LipWalls {
  static constexpr std::size_t kMostRows = 7;
  /// The end of a wall that goes on when the stroke does: the points below a point of the lip.
  struct End {
    Index point = kNone;
    double along = 0;   ///< Its place along the rim, metres.
    double to_tip = 0;  ///< Its distance from the nearest tip along the rim, metres.
    Index row_count = 0;
    std::array<Index, kMostRows> rows = {};
  };
  std::vector<End> ends;
  std::vector<FillingSubmesh> submeshes;
  /// Half-edges of lips, ascending, whose walls could not be joined to the surface: they are tried
  /// once more when the stroke is complete.
  std::vector<Index> refused;

  void clear() {
    ends.clear();
    refused.clear();
    submeshes.clear();
  }
};

}  // namespace sunder::tear
