#pragma once

#include "tear/posed_points.h"

namespace sunder::tear {

/// What an operation works on.
struct Workpiece {
  SurfaceEditor& editor;
  PosedPoints& posed;
  Index& next_side;  ///< First free value of _TEARSIDE.
};

}  // namespace sunder::tear
