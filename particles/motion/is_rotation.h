#pragma once

#include <sunder/core/math.h>

#include "core/internal/ordered.h"
#include "particles/internal/recorded_limits.h"

namespace sunder::particles {

/// Whether a recorded matrix is a rotation, but for rounding.
[[nodiscard]] inline bool is_rotation(const Mat3d& matrix) {
  const Mat3d error = multiply(Mat3d(matrix.transpose()), matrix) - Mat3d(Mat3d::Identity());
  return error.cwiseAbs().maxCoeff() <= kRecordedTurnError && determinant(matrix) > 0;
}

}  // namespace sunder::particles
