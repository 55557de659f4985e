#pragma once

#include <sunder/core/math.h>

namespace sunder::tear {

/// The parallelogram between two vectors of a plane: positive if `b` is to the left of `a`.
inline double cross(const Vec2d& a, const Vec2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace sunder::tear
