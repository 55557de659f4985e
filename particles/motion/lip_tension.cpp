#include "particles/motion/lip_tension.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "particles/clusters/structure_of.h"

namespace sunder::particles {
namespace {

/// A shorter direction counts as none.
constexpr double kLeastDirection = 1e-12;

/// Newtons per metre at a lip edge: the smaller share and the mean factor of its ends.
double tension_at(const LipEdge& lip, const LipTension& of) {
  const Tension& tension = of.tension;
  double share = 1;
  for (const Index point : lip.points)
    if (point < tension.shares.size())
      share = std::min(share, static_cast<double>(tension.shares[point]));
  if (!of.factors.empty())
    share *= 0.5 * (double{of.factors[lip.points[0]].tension} +
                    double{of.factors[lip.points[1]].tension});
  return share * tension.newtons_per_metre;
}

Vec3d pull_of(const LipEdge& lip, std::span<const Vec3f> positions, const LipTension& of) {
  const Vec3d inward = lip.inward.cast<double>();
  const double newtons_per_metre = tension_at(lip, of);
  if (!of.tension.direction) return newtons_per_metre * inward;
  const Vec3d middle = 0.5 * (positions[lip.points[0]] + positions[lip.points[1]]).cast<double>();
  const Vec3d direction = of.tension.direction(middle);
  const double length = norm(direction);
  if (!(length > kLeastDirection) || !direction.allFinite()) return Vec3d::Zero();
  return newtons_per_metre / (length * length) * dot(direction, inward) * direction;
}

/// The pull with what the pose adds, without the part that would push the lip into the opening.
Vec3d with_added(const Vec3d& pull, const Mat3d& added, const LipEdge& lip) {
  const Vec3d inward = lip.inward.cast<double>();
  const Vec3d sum = pull + multiply(added, inward);
  const double along = dot(sum, inward);
  return along < 0 ? Vec3d(sum - along / squared_norm(inward) * inward) : sum;
}

}  // namespace

Vec3d pull_at(const LipEdge& lip, std::span<const Vec3f> positions, const LipTension& tension,
              Index owner) {
  const Vec3d pull = pull_of(lip, positions, tension);
  return tension.added.empty() ? pull : with_added(pull, tension.added[owner], lip);
}

void add_lip_forces(std::span<const LipEdge> lips, std::span<const Vec3f> positions,
                    std::span<const Index> owners, const LipTension& tension,
                    std::span<Vec3d> forces) {
  if (!(tension.tension.newtons_per_metre > 0) && tension.added.empty()) return;
  for (const LipEdge& lip : lips) {
    const Vec3d pull = pull_of(lip, positions, tension);
    for (const Index point : lip.points) {
      const Index owner = owners[point];
      if (owner == kNone) continue;
      forces[owner] +=
          0.5 * (tension.added.empty() ? pull : with_added(pull, tension.added[owner], lip));
    }
  }
}

void pull_lips(const ParticleSet& set, const Tension& tension, std::span<const Mat3d> added,
               Motion& motion, std::vector<Vec3d>& scratch, std::vector<Index>& changed) {
  scratch.assign(motion.count(), Vec3d::Zero());
  changed.clear();
  const std::vector<PointFactors>& factors = StructureOf::in(set).authored.of_points;
  add_lip_forces(set.lips(), set.positions(), set.owners(), {tension, added, factors}, scratch);
  for (Index p = 0; p < motion.count(); ++p)
    if (motion.lip_forces[p] != scratch[p]) {
      motion.lip_forces[p] = scratch[p];
      changed.push_back(p);
    }
}

}  // namespace sunder::particles
