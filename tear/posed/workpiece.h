#pragma once

#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// The surface that an operation changes, and its points in the pose of the operation.
struct Workpiece {
  SurfaceEditor& editor;
  PosedPoints& posed;
};

}  // namespace sunder::tear
