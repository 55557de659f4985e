#pragma once

#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// What an operation works on.
struct Workpiece {
  SurfaceEditor& editor;
  PosedPoints& posed;
};

}  // namespace sunder::tear
