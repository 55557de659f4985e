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

  /// A bound of the error of a distance: a part that does not depend on the number of influences,
  /// and what each adds.
  struct Error {
    float of_place = 0, per_influence = 0;

    [[nodiscard]] float with(float influences) const {
      return of_place + influences * per_influence;
    }
  };
  /// @param sizes  a bound of |x| + |y| + |z|, of a bind position.
  [[nodiscard]] Error error_at(float sizes) const {
    const float terms = terms_at(sizes);
    return {kInFloat * terms + rounding_, kFloatTerms * terms + slack_};
  }

  /// The side of a vertex without displacements that is not on the plane, if rounding cannot change
  /// it; otherwise kAcross.
  [[nodiscard]] std::uint8_t side_of(const Vec3f& bind, std::span<const Influence> influences,
                                     const Error& error) const {
    Lanes sum = Lanes::Zero();
    for (const Influence& influence : influences)
      sum += influence.weight * Eigen::Map<const Lanes>(rows_[influence.slot].of.data());
    const float distance = (sum[0] * bind.x() + sum[1] * bind.y()) + (sum[2] * bind.z() + sum[3]);
    const float most = error.with(static_cast<float>(influences.size()));
    return distance > most ? kInside : distance < -most ? kOutside : kAcross;
  }
  [[nodiscard]] std::uint8_t side_of(const Vec3f& bind,
                                     std::span<const Influence> influences) const {
    return side_of(bind, influences,
                   error_at(std::abs(bind.x()) + std::abs(bind.y()) + std::abs(bind.z())));
  }

  /// The distance of a place that follows one bone is of . (x, y, z, 1); `size` holds the absolute
  /// values of its first three numbers.
  struct Row {
    std::array<float, 4> of, size;
  };
  [[nodiscard]] const Row& row(std::size_t slot) const { return rows_[slot]; }
  /// A bound of the sum of the magnitudes of the terms of a distance, at |x| + |y| + |z|.
  [[nodiscard]] float terms_at(float sizes) const { return steepest_ * sizes + farthest_; }

 private:
  using Lanes = Eigen::Array<float, 4, 1>;
  static constexpr auto kInFloat = static_cast<float>(kInFloatTerms);

  ScratchVector<Row> rows_;            ///< Per slot.
  float steepest_ = 0, farthest_ = 0;  ///< Bounds of the terms of a distance.
  float slack_ = 0;  ///< Error per influence, because weights do not sum to one exactly.
  /// Error of the posed position in double, plus `on_plane`. Infinite if float cannot hold the
  /// distances.
  float rounding_ = 0;
};

}  // namespace sunder::tear
