#pragma once

#include <sunder/core/index.h>

#include <cstdint>

namespace sunder::particles {

/// The side of a tear.
enum class Side : std::uint8_t { left, right };

/// Membership of a point in a lip of a tear.
struct OnLip {
  Index tear = kNone;
  Side side = Side::left;
  /// In PointTable::older_lips: the lip of an earlier tear on which the point also lies.
  Index older = kNone;
};

/// The newest lip of a point, if any, and the index of the lip edge that leaves the point.
struct LipPoint : OnLip {
  Index edge = kNone;  ///< In Structure::lips.
};

}  // namespace sunder::particles
