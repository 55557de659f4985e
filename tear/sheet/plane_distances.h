#pragma once

#include <sunder/core/mesh.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "tear/geometry/plane_side.h"
#include "tear/geometry/tolerances.h"
#include "tear/surface/scratch_memory.h"

namespace sunder::tear {

/// Tells on which side of a plane the posed vertices of a skin lie. It computes their distances
/// from the plane in float: per bone, four numbers turn a bind position into a distance, which
/// costs a fraction of posing the vertex. Where rounding cannot change the side, the answer is that
/// of PlaneSide::contains() for the posed position.
class PlaneDistances {
 public:
  /// Where a vertex may be.
  static constexpr std::uint8_t kInside = 1, kOutside = 2, kAcross = kInside | kOutside;

  /// @param on_plane  the distance from the plane within which a vertex may be on it.
  PlaneDistances(const PlaneSide& plane, std::span<const Affine3d> palette, double on_plane,
                 ScratchMemory& memory);

  /// The side of a vertex without displacements that is not on the plane, if rounding cannot change
  /// it; otherwise kAcross.
  [[nodiscard]] std::uint8_t side_of(const Vec3f& bind,
                                     std::span<const Influence> influences) const {
    Lanes sum = Lanes::Zero();
    for (const Influence& influence : influences)
      sum += influence.weight * Eigen::Map<const Lanes>(rows_[influence.slot].data());
    const float x = bind.x(), y = bind.y(), z = bind.z();
    const float distance = (sum[0] * x + sum[1] * y) + (sum[2] * z + sum[3]);
    const float terms = steepest_ * (std::abs(x) + std::abs(y) + std::abs(z)) + farthest_;
    const float error = kInFloat * terms + rounding_ +
                        static_cast<float>(influences.size()) * (kFloatTerms * terms + slack_);
    return distance > error ? kInside : distance < -error ? kOutside : kAcross;
  }

 private:
  using Lanes = Eigen::Array<float, 4, 1>;
  static constexpr auto kInFloat = static_cast<float>(kInFloatTerms);

  ScratchVector<std::array<float, 4>> rows_;  ///< Per slot.
  float steepest_ = 0, farthest_ = 0;         ///< Bounds of the terms of a distance.
  float slack_ = 0;  ///< Error per influence, because weights do not sum to one exactly.
  /// Error of the posed position in double, plus `on_plane`. Infinite if float cannot hold the
  /// distances.
  float rounding_ = 0;
};

}  // namespace sunder::tear
