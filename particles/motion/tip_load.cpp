#include "particles/motion/tip_load.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/internal/ordered.h"
#include "particles/clusters/lip_border.h"
#include "particles/clusters/lip_spacing.h"
#include "particles/clusters/structure_of.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

/// Number of distances from the tip at which a gap is measured.
constexpr int kSamples = 16;

/// A lip from a tip on.
class LipFromTip {
 public:
  ///
  /// @param tips  ascending; the lip ends at the next one.
  /// @param longest  where a longer lip ends, metres.
  LipFromTip(const SoftBody& body, const ParticleSet& particles, const LipBorder& border,
             std::span<const Index> tips, Index tip, bool forward, double longest)
      : body_(body), particles_(particles) {
    Index at = tip;
    double distance = 0;
    // Edges without length may lead in a circle.
    while (distance < longest && !ends_at_tip_ && points_.size() < particles.point_count()) {
      const Index following = forward ? border.next(at) : border.previous(at);
      if (following == kNone) break;
      ends_at_tip_ = std::ranges::binary_search(tips, following);
      distance += norm(
          Vec3d((particles.positions()[following] - particles.positions()[at]).cast<double>()));
      points_.push_back({following, distance});
      at = following;
    }
  }

  [[nodiscard]] bool empty() const { return points_.empty(); }
  [[nodiscard]] Index first_owner() const { return particles_.owners()[points_[0].point]; }
  /// Of the lip between two tips; infinite if no other one is near.
  [[nodiscard]] double length() const {
    return ends_at_tip_ ? points_.back().distance : std::numeric_limits<double>::infinity();
  }
  /// The displacement at a distance from the tip, linear between points.
  [[nodiscard]] Vec3d displacement(double distance) const {
    const auto after = std::ranges::lower_bound(points_, distance, {}, &Place::distance);
    if (after == points_.end()) return body_.point_displacement(points_.back().point);
    const Vec3d there = body_.point_displacement(after->point);
    if (after == points_.begin()) return there;
    const auto before = after - 1;
    const double t = (distance - before->distance) / (after->distance - before->distance);
    return body_.point_displacement(before->point) * (1 - t) + there * t;
  }

 private:
  struct Place {
    Index point = 0;
    double distance = 0;
  };
  const SoftBody& body_;
  const ParticleSet& particles_;
  std::vector<Place> points_;
  bool ends_at_tip_ = false;
};

}  // namespace

std::vector<TipLoad> tip_loads(const SoftBody& body, const ParticleSet& particles,
                               const TornModel& model, std::span<const Index> tips) {
  const LipBorder border(model);
  const auto range = static_cast<float>(particles.report().range);
  const double longest = double{kLeastPerLip} * kLipSpacingRanges * range;
  std::vector<TipLoad> loads;
  for (const Index tip : tips) {
    const LipFromTip one(body, particles, border, tips, tip, true, longest),
        other(body, particles, border, tips, tip, false, longest);
    if (one.empty() || other.empty()) continue;
    TipLoad load{tip, one.first_owner(), other.first_owner(), 0};
    if (load.left == kNone || load.right == kNone ||
        (!body.is_awake(load.left) && !body.is_awake(load.right)))
      continue;
    const double length = std::min(one.length(), other.length());
    if (!(length > 0)) continue;
    const double spacing = double{lip_spacing(
        range, StructureOf::in(particles).character.edge_length, static_cast<float>(length))};
    double sum = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double distance = spacing * (0.5 + 2.0 * (i + 0.5) / kSamples);
      sum += squared_norm(Vec3d(one.displacement(distance) - other.displacement(distance))) /
             (distance * (1 - distance / std::max(length, 4 * distance)));
    }
    const double stiffness =
        std::min(body.materials()[body.material_of(load.left)].membrane_stiffness,
                 body.materials()[body.material_of(load.right)].membrane_stiffness);
    load.release = kReleaseOfMean * std::numbers::pi / 16 * stiffness * sum / kSamples;
    loads.push_back(load);
  }
  return loads;
}

}  // namespace sunder::particles
