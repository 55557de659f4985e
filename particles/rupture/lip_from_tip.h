#pragma once

#include <limits>
#include <vector>

#include "particles/rupture/tissue.h"

namespace sunder::particles {

/// A lip from a tip on.
class LipFromTip {
 public:
  /// Along the border, with the surface to the left, or against it.
  enum class Way : std::uint8_t { forward, backward };

  /// @param tips  ascending; the lip ends at the next one.
  /// @param longest  where a longer lip ends, metres. O(points of the lip), allocates.
  LipFromTip(const Tissue& tissue, std::span<const Index> tips, Index tip, Way way, double longest);

  [[nodiscard]] bool empty() const { return places_.empty(); }
  [[nodiscard]] Index first_owner() const { return tissue_.set.owners()[places_.front().point]; }
  /// Metres from the tip to the next one; infinite if that is not near.
  [[nodiscard]] double length_to_tip() const {
    return ends_at_tip_ ? places_.back().distance : std::numeric_limits<double>::infinity();
  }
  /// Metres from the tip to where the lip ends, at a tip or at another border; infinite if neither
  /// is near.
  [[nodiscard]] double length() const {
    return ends_at_tip_ || ends_at_border_ ? places_.back().distance
                                           : std::numeric_limits<double>::infinity();
  }
  /// The displacement at a distance from the tip, linear between points.
  [[nodiscard]] Vec3d displacement(double distance) const;
  /// The mean direction from the lip into the surface, in model space, between two distances from
  /// the tip, weighted as 1 / sqrt(distance); of the last edge if the lip is shorter. It is shorter
  /// than 1 where the lip is bent.
  [[nodiscard]] Vec3d inward(double begin, double end) const;
  /// The sum over the edges of weight(begin, end) times the tension's pull per length, N/m, in
  /// model space; begin and end are distances from the tip.
  template <class Weight>
  [[nodiscard]] Vec3d pull_weighted(Weight weight) const {
    Vec3d sum = Vec3d::Zero();
    double from = 0;
    for (const Place& place : places_) {
      if (place.distance > from) sum += weight(from, place.distance) * pull_of(place);
      from = place.distance;
    }
    return sum;
  }

 private:
  struct Place {
    Index point = 0, half_edge = 0;  ///< The half-edge between this point and the one before.
    double distance = 0;
  };
  [[nodiscard]] LipEdge edge_of(const Place& place) const;
  [[nodiscard]] Vec3d pull_of(const Place& place) const;

  const Tissue& tissue_;
  std::vector<Place> places_;
  bool ends_at_tip_ = false, ends_at_border_ = false;
};

}  // namespace sunder::particles
