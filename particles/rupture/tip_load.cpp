#include "particles/rupture/tip_load.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/internal/elementary.h"
#include "core/internal/ordered.h"
#include "particles/clusters/lip_spacing.h"
#include "particles/clusters/structure_of.h"
#include "particles/internal/angular_frequency.h"
#include "particles/internal/tolerances.h"
#include "particles/rupture/lip_from_tip.h"
#include "particles/rupture/other_loads.h"
#include "particles/rupture/tip_disc.h"

namespace sunder::particles {
namespace {

/// The mean of two materials, half of each.
struct Membrane {
  double stiffness = 0;  ///< N/m.
  double decay = 0;      ///< One over the tissue's reach, 1/m.

  Membrane(const SoftMaterial& a, const SoftMaterial& b) {
    const double sum = a.membrane_stiffness + b.membrane_stiffness;
    if (!(sum > 0)) return;
    stiffness = 2 * a.membrane_stiffness * (b.membrane_stiffness / sum);
    const double foundation = 0.5 * (a.areal_density * squared_frequency(a.return_frequency) +
                                     b.areal_density * squared_frequency(b.return_frequency));
    if (stiffness > 0) decay = std::sqrt(foundation / stiffness);
  }
};

/// A function that is 1 at a tip and 0 at the end of its disc, with its derivatives.
class Cutoff {
 public:
  explicit Cutoff(double radius) : core_(kTipCorePart * radius), width_(radius - core_) {}

  [[nodiscard]] double value(double distance) const {
    const double t = part(distance);
    return 1 - t * t * (3 - 2 * t);
  }
  [[nodiscard]] double slope(double distance) const {
    const double t = part(distance);
    return -6 * t * (1 - t) / width_;
  }
  [[nodiscard]] double curvature(double distance) const {
    const double t = part(distance);
    return t > 0 && t < 1 ? (12 * t - 6) / (width_ * width_) : 0.0;
  }

 private:
  [[nodiscard]] double part(double distance) const {
    return std::clamp((distance - core_) / width_, 0.0, 1.0);
  }
  double core_, width_;
};

/// The direction across the lips, from the first to the second, along the surface; zero if they
/// have none, as at the rim of two layers that lie upon one another.
Vec3d across_lips(const LipFromTip& first, const LipFromTip& second, double begin, double end) {
  return normalized(Vec3d(second.inward(begin, end) - first.inward(begin, end)));
}

/// The squared length of a displacement of the second lip from the first, without the part that
/// would push them into one another: lips that touch carry pressure, and a pressure at both lips
/// moves them across only.
double squared_parting(const Vec3d& parting, const Vec3d& across) {
  const double closing = std::min(dot(parting, across), 0.0);
  return squared_norm(Vec3d(parting - closing * across));
}

/// The factor a of the displacement a sqrt(r) sin(theta / 2) at a sharp tip.
///
/// psi = exp(-r / reach) / sqrt(r) sin(theta / 2) solves the membrane's equation without loads, and
/// pulls at no lip. With a cutoff c, the reciprocal theorem for u and c psi says
///   pi a = integral of u (c'' - 2 c' / reach) psi + 1 / S integral of loads c psi
/// over the disc and its lips. The first integral is taken where the cutoff changes, away from the
/// tip, where the blending of few particles blunts the field.
Vec3d opening_at(const Tissue& tissue, const TipDisc& disc, const Membrane& membrane, double radius,
                 const LipFromTip& first, const LipFromTip& second) {
  const Cutoff cutoff(radius);
  // Per distance: the area of a sample, and what psi is without sin(theta / 2).
  std::array<double, TipDisc::kDistances> areas, decays, changes, values;
  for (std::size_t i = 0; i < TipDisc::kDistances; ++i) {
    const double r = TipDisc::distance(i, radius);
    areas[i] = r * disc.area_per_distance(radius);
    decays[i] = elementary::exp(-membrane.decay * r) / std::sqrt(r);
    changes[i] = cutoff.curvature(r) - 2 * membrane.decay * cutoff.slope(r);
    values[i] = cutoff.value(r);
  }
  OtherLoads loads(tissue);
  Vec3d field = Vec3d::Zero();
  disc.for_each_line(radius, [&](double angle, std::span<const TipSample> samples) {
    const double half = elementary::sin(std::numbers::pi * angle / disc.angle());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double psi = half * decays[i];
      field += areas[i] * changes[i] * psi * samples[i].displacement;
      if (samples[i].owner != kNone) loads.add(samples[i].owner, areas[i], values[i] * psi);
    }
  });
  Vec3d loaded = loads.sum();
  const auto pulled = [&](const LipFromTip& lip) {
    return lip.pull_weighted([&](double from, double to) {
      const double middle = 0.5 * (from + to);
      return cutoff.value(middle) * elementary::exp(-membrane.decay * middle) * 2 *
             (std::sqrt(to) - std::sqrt(from));  // the integral of 1 / sqrt(r)
    });
  };
  loaded += pulled(second) - pulled(first);
  return 2 / disc.angle() * (field + loaded / membrane.stiffness);
}

/// The same at the blunt end of a gap, which has no such field in front: by the width of the gap
/// farther away, 2 a sqrt(r (1 - r / length)).
double squared_opening_by_width(const LipFromTip& first, const LipFromTip& second, double spacing,
                                double length) {
  constexpr int kSamples = 16;
  const Vec3d across = across_lips(first, second, 2 * spacing, 5 * spacing);
  double sum = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double distance = spacing * (2 + 3 * (i + 0.5) / kSamples);
    sum += squared_parting(second.displacement(distance) - first.displacement(distance), across) /
           (4 * distance * (1 - distance / std::max(length, 2 * distance)));
  }
  return sum / kSamples;
}

}  // namespace

std::vector<TipLoad> tip_loads(const Tissue& tissue, std::span<const Index> tips) {
  const auto range = static_cast<float>(tissue.set.report().range);
  const double longest = double{kLeastPerLip} * kLipSpacingRanges * range;
  std::vector<TipLoad> loads;
  for (const Index tip : tips) {
    const LipFromTip first(tissue, tips, tip, LipFromTip::Way::forward, longest),
        second(tissue, tips, tip, LipFromTip::Way::backward, longest);
    if (first.empty() || second.empty()) continue;
    TipLoad load{tip, first.first_owner(), second.first_owner()};
    if (load.left == kNone || load.right == kNone ||
        (!tissue.is_awake(load.left) && !tissue.is_awake(load.right)))
      continue;
    const double length = std::min(first.length(), second.length());
    const Membrane membrane(tissue.material(load.left), tissue.material(load.right));
    if (!(length > 0) || !(membrane.stiffness > 0)) continue;
    const double spacing = double{
        lip_spacing(range, StructureOf::in(tissue.set).character.edge_length,
                    static_cast<float>(std::min(first.length_to_tip(), second.length_to_tip())))};
    load.radius = std::min({kTipDiscSpacings * spacing, length, longest});
    const TipDisc disc(tissue, tip);
    const double squared =
        disc.angle() > kSharpTipAngle
            ? squared_parting(opening_at(tissue, disc, membrane, load.radius, first, second),
                              across_lips(first, second, 0, load.radius))
            : squared_opening_by_width(first, second, spacing, length);
    load.release = std::numbers::pi / 4 * membrane.stiffness * squared;
    loads.push_back(load);
  }
  return loads;
}

}  // namespace sunder::particles
