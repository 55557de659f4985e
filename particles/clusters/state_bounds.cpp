#include "particles/clusters/state_bounds.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "particles/internal/recorded_limits.h"
#include "particles/internal/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

double largest_of(std::span<const Vec3f> values) {
  float most = 0;
  for (const Vec3f& value : values) most = std::max(most, value.cwiseAbs().maxCoeff());
  return most;
}

bool is_at_most(const Vec3d& value, double most) { return value.cwiseAbs().maxCoeff() <= most; }

}  // namespace

StateBounds::StateBounds(const Structure& decomposition, const TornModel& model) {
  Eigen::AlignedBox3f box;
  for (const Vec3f& at : decomposition.points.positions) box.extend(Eigen::Vector3f(at));
  if (!box.isEmpty()) {
    middle = box.center();
    largest = static_cast<float>(kRecordedPlaceDiagonals) * norm(box.diagonal());
  }
  for (Index m = 0; m < model.character().meshes.size(); ++m) {
    const Mesh& mesh = model.character().meshes[m];
    member = std::max(
        {member, largest_of(mesh.positions), largest_of(model.influence_positions(m).positions)});
    for (const MorphTarget& target : mesh.morph_targets)
      morph = std::max(morph, largest_of(target.position_deltas));
    for (const auto& target : model.influence_positions(m).morph_targets)
      morph = std::max(morph, largest_of(target.positions));
  }
  // Weights, and the places of influences, may have been others before.
  member *= kRecordedSumFactor;
  morph *= kRecordedSumFactor;
  range = static_cast<float>(decomposition.report.range);
  least_range = static_cast<float>(kLeastRecordedRange) * range;
  faces_ = model.surface().triangle_count();
}

bool StateBounds::fits_members(const Particle& particle) const {
  const double count = particle.member_count + 1.0;
  double weights = 0;
  for (const RestTerm& term : particle.terms) {
    if (!is_at_most(term.sum.head<3>(), count * member) ||
        term.sum.w() < -kRecordedSumError * count)
      return false;
    weights += term.sum.w();
  }
  for (const RestMorphTerm& term : particle.morph_terms)
    if (!is_at_most(term.sum, count * morph)) return false;
  return std::abs(weights - particle.member_count) <= kRecordedSumError * count;
}

bool StateBounds::fits_cell(const Particle& particle) const {
  const double size = 2.0 * largest, place = size + middle.cwiseAbs().maxCoeff();
  if (!(particle.area >= -kRecordedSumError * size * size &&
        particle.area <= (faces_ + 1) * size * size))
    return false;
  Index next = 0;
  for (const ParticleNeighbour& of : particle.neighbours) {
    const double edges = of.edges;
    // The cotangent of an angle is at most 1 / kNeedleFraction.
    const bool fits = of.particle >= next && edges > 0 && edges <= 3 * faces_ &&
                      is_at_most(of.across, edges * size / kNeedleFraction) &&
                      is_at_most(of.middles, edges * place) && of.coupling >= 0 &&
                      of.coupling <= kMostRecordedCoupling;
    if (!fits) return false;
    next = of.particle + 1;
  }
  return true;
}

bool StateBounds::fits(const Particle& particle) const {
  return particle.range >= least_range && particle.range <= range && fits_members(particle) &&
         fits_cell(particle);
}

}  // namespace sunder::particles
