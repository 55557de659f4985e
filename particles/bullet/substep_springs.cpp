#include "particles/bullet/substep_springs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "particles/internal/angular_frequency.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

constexpr int kMostSubstepIterations = 64;
/// Greatest decay of a spring per substep. Stronger damping between neighbours would make the
/// system ill-conditioned.
constexpr double kMostDecay = 16, kMostDecayOfPairs = 2;

/// The spring that goes exactly through the places of x'' = -f^2 x - 2 d f x', substep after
/// substep: its step has the eigenvalues of that motion, exp((-d +- sqrt(d^2 - 1)) f h). It is
/// bounded by itself, and in any sum of such springs whose masses are shares of the particle's: h
/// stiffness <= 2 + damping, half of what would grow.
SubstepSpring over_substep(double frequency, double damping_ratio, double seconds,
                           double most_decay) {
  const double angle = std::min(frequency * seconds, std::numbers::pi / 2);
  const double decay = std::min(damping_ratio * angle, most_decay);
  const double square = angle * angle - decay * decay;
  const double swing = square >= 0 ? std::cos(std::sqrt(square)) : std::cosh(std::sqrt(-square));
  const double alpha = std::exp(-2 * decay);
  const double beta = std::max(0.0, 1 + alpha - 2 * std::exp(-decay) * swing) / seconds;
  return {(1 - alpha) / alpha, beta / alpha};
}

void clear_held(Columns& columns, const std::vector<char>& held) {
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i] != 0) columns.col(static_cast<Eigen::Index>(i)).setZero();
}

}  // namespace

SubstepSprings::SubstepSprings(const BulletBodyOptions& options)
    : return_frequency_(angular_frequency(options.return_frequency)),
      neighbour_stiffness_(options.neighbour_stiffness),
      damping_ratio_(options.damping_ratio) {}

std::vector<SubstepSprings::Pair> SubstepSprings::pairs_of(const ParticleSet& set) const {
  std::vector<Pair> pairs;
  if (!(neighbour_stiffness_ > 0)) return pairs;
  std::vector<double> coupled(set.particle_count(), 0.0);
  for (Index a = 0; a < set.particle_count(); ++a)
    for (const ParticleNeighbour& neighbour : set.neighbours(a)) {
      if (neighbour.particle <= a) continue;
      const double coupling = neighbour.coupling;
      if (!(coupling > 0)) continue;
      pairs.push_back({a, neighbour.particle, coupling, 0, {}});
      coupled[a] += coupling;
      coupled[neighbour.particle] += coupling;
    }
  // Each spring moves a share of the masses that it joins, in proportion to its part of the forces
  // on them. No mass is moved twice, so the sum of springs is stable because each of them is.
  for (Pair& pair : pairs) {
    const double most = std::max(coupled[pair.a], coupled[pair.b]);
    pair.frequency = std::sqrt(2 * neighbour_stiffness_ * most);
    pair.share = pair.share / (2 * most);
  }
  return pairs;
}

void SubstepSprings::make_room(Index count) {
  for (Columns* columns : {&solved_, &residual_, &direction_, &product_})
    *columns = Columns::Zero(3, count);
  diagonal_.resize(count);
}

void SubstepSprings::connect(std::vector<Pair> pairs) {
  pairs_ = std::move(pairs);
  forget_substep();
}

bool SubstepSprings::set_substep(double seconds) {
  if (seconds == springs_for_) return false;
  springs_for_ = seconds;
  return_spring_ = over_substep(return_frequency_, damping_ratio_, seconds, kMostDecay);
  diagonal_.setConstant(1 + return_spring_.damping);
  for (Pair& pair : pairs_) {
    pair.spring = over_substep(pair.frequency, damping_ratio_, seconds, kMostDecayOfPairs);
    pair.spring.damping *= pair.share;
    pair.spring.stiffness *= pair.share;
    diagonal_[pair.a] += pair.spring.damping;
    diagonal_[pair.b] += pair.spring.damping;
  }
  return true;
}

/// y = A x, where A = 1 + damping of all springs; rows of held particles are left out.
void SubstepSprings::multiply(const Columns& x, Columns& y, const std::vector<char>& held) const {
  y = (1 + return_spring_.damping) * x;
  for (const Pair& pair : pairs_) {
    const Vec3d pulled = pair.spring.damping * (x.col(pair.a) - x.col(pair.b));
    y.col(pair.a) += pulled;
    y.col(pair.b) -= pulled;
  }
  clear_held(y, held);
}

double SubstepSprings::weighted(const Columns& x) const {
  return (x.colwise().squaredNorm().array() / diagonal_.transpose().array()).sum();
}

const Columns& SubstepSprings::solve(const Columns& relative, const Columns& displaced,
                                     const std::vector<char>& held) {
  residual_ = relative - return_spring_.stiffness * displaced;
  for (const Pair& pair : pairs_) {
    const Vec3d pulled = pair.spring.stiffness * (displaced.col(pair.a) - displaced.col(pair.b));
    residual_.col(pair.a) -= pulled;
    residual_.col(pair.b) += pulled;
  }
  for (Eigen::Index i = 0; i < solved_.cols(); ++i)
    solved_.col(i) = held[static_cast<std::size_t>(i)] != 0
                         ? Vec3d(relative.col(i))
                         : Vec3d(residual_.col(i) / diagonal_[i]);
  if (pairs_.empty()) return solved_;
  clear_held(residual_, held);
  const double enough = kBulletSquaredResidual * weighted(residual_);
  multiply(solved_, product_, held);
  residual_ -= product_;
  double size = weighted(residual_);
  direction_ = residual_ * diagonal_.cwiseInverse().asDiagonal();
  for (int iteration = 0; iteration < kMostSubstepIterations && size > enough; ++iteration) {
    multiply(direction_, product_, held);
    const double along = direction_.cwiseProduct(product_).sum();
    if (!(along > 0)) return solved_;
    solved_ += (size / along) * direction_;
    residual_ -= (size / along) * product_;
    const double left = weighted(residual_);
    direction_ = residual_ * diagonal_.cwiseInverse().asDiagonal() + (left / size) * direction_;
    size = left;
  }
  return solved_;
}

}  // namespace sunder::particles
