#pragma once

#include <array>
#include <vector>

#include "particles/rupture/tissue.h"

namespace sunder::particles {

/// A place near a tip, and how the tissue moved there.
struct TipSample {
  Index owner = kNone;  ///< The particle in whose cell the place is; kNone: none.
  Vec3d displacement = Vec3d::Zero();
};

/// The disc around a tip, sampled in polar coordinates: along straight lines from the tip, across
/// faces that are unfolded into a plane. So distances and angles are right on any surface that
/// bends without stretching.
class TipDisc {
 public:
  static constexpr std::size_t kDirections = 24, kDistances = 16;

  /// The faces between the two lips. O(faces around the tip), allocates.
  TipDisc(const Tissue& tissue, Index tip);

  /// The angle of the surface between the two lips, radians: about 2 pi, less at the blunt end of
  /// a gap; 0 if there are no lips.
  [[nodiscard]] double angle() const { return angle_; }
  /// The distance of a sample from the tip along the surface.
  [[nodiscard]] static double distance(std::size_t sample, double radius) {
    return (static_cast<double>(sample) + 0.5) / kDistances * radius;
  }
  /// The area for which a sample stands, divided by its distance.
  [[nodiscard]] double area_per_distance(double radius) const {
    return angle_ / kDirections * radius / kDistances;
  }
  /// Calls visit(angle, samples) for lines to the middles of equal parts of the angle, which is
  /// counted counter-clockwise from the middle between the lips. Beyond a border the displacement
  /// is that of the border. O(faces that the lines cross), no allocation.
  template <class Visit>
  void for_each_line(double radius, Visit visit) const {
    std::array<TipSample, kDistances> samples;
    for (std::size_t i = 0; i < kDirections; ++i) {
      const double direction = (static_cast<double>(i) + 0.5) / kDirections * angle_;
      sample_line(direction, radius, samples);
      visit(direction - angle_ / 2, std::span<const TipSample>(samples));
    }
  }

 private:
  struct Face {
    Index corner = kNone;         ///< That of the tip.
    double begins = 0, ends = 0;  ///< Angles of its edges, from that of the first lip.
  };
  void sample_line(double direction, double radius,
                   std::array<TipSample, kDistances>& samples) const;

  const Tissue& tissue_;
  Index tip_ = kNone;
  std::vector<Face> faces_;
  double angle_ = 0;
};

}  // namespace sunder::particles
