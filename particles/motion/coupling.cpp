#include "particles/motion/coupling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

/// The damping of a spring, increased if the step does not resolve the spring: otherwise the place
/// at the end of each step is met, but the velocity there alternates for ever.
double damping_of(double stiffness, double damping, double frequency, double seconds) {
  if (frequency * seconds <= 2) return damping;
  return std::max(damping, stiffness * (seconds - 2 / frequency));
}

/// Velocity per distance moved, at the end of a step under a constant acceleration. Not positive if
/// the particle's own spring turns back within the step: then its end velocity does not reflect the
/// force.
double velocity_a_place(const SpringStep& step) {
  return step.place_from_acceleration > 0
             ? step.velocity_from_acceleration() / step.place_from_acceleration
             : 0.0;
}

Eigen::Vector4d padded(const Vec3d& v) { return {v.x(), v.y(), v.z(), 0.0}; }

/// Inner products of all rows are summed per coordinate, which has one order with any vector
/// instructions, and by this in the end.
double total(const Eigen::Vector4d& sums) { return sums.x() + sums.y() + sums.z(); }

}  // namespace

void CouplingSolver::assemble(const Inputs& in) {
  const std::size_t rows = in.active.size();
  row_of_.assign(in.places.size(), kNone);
  for (Index i = 0; i < rows; ++i) row_of_[in.active[i]] = i;
  first_.assign(1, 0);
  entries_.clear();
  diagonal_.resize(rows);
  right_.resize(rows);
  ratios_.clear();
  for (const SpringStep& step : in.steps) ratios_.push_back(velocity_a_place(step));
  for (Index i = 0; i < rows; ++i) {
    const Index p = in.active[i];
    const SpringStep& step = in.steps[in.material_of[p]];
    const double ratio = ratios_[in.material_of[p]];
    const Vec3d& place = in.places[p];
    const Vec3d& velocity = in.velocities[p];
    double sum = in.graph.masses[p] / step.place_from_acceleration;
    Vec3d pull = Vec3d::Zero();
    for (const Spring& spring : in.graph.of(p)) {
      if (!(spring.stiffness > 0)) continue;
      const Index q = spring.other, column = row_of_[q];
      const double other_ratio = column == kNone ? ratio : ratios_[in.material_of[q]];
      const double greater = std::max(ratio, other_ratio);
      // If a ratio is not positive, the end velocity does not reflect how fast the two separate.
      const double damping =
          std::min(ratio, other_ratio) > 0
              ? damping_of(spring.stiffness, spring.damping, spring.frequency, in.seconds)
              : 0.0;
      const double value = spring.stiffness + damping * greater;
      sum += value;
      pull -= spring.stiffness * (place - in.places[q]) + damping * (velocity - in.velocities[q]);
      if (column != kNone) entries_.push_back({column, value});
    }
    diagonal_[i] = sum;
    right_[i] = padded(pull);
    first_.push_back(static_cast<Index>(entries_.size()));
  }
}

void CouplingSolver::assemble_pulls(const Inputs& in) {
  pulls_.clear();
  for (const PointPull& pull : in.pulls) {
    ActivePull active;
    double least = std::numeric_limits<double>::infinity(), greatest = 0;
    Vec3d place = -pull.target, velocity = Vec3d::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      if (!(pull.weights[k] > 0)) continue;
      const Index p = pull.particles[k];
      place += pull.weights[k] * in.places[p];
      velocity += pull.weights[k] * in.velocities[p];
      if (row_of_[p] == kNone) continue;
      active.rows[k] = row_of_[p];
      active.weights[k] = pull.weights[k];
      const double ratio = ratios_[in.material_of[p]];
      least = std::min(least, ratio);
      greatest = std::max(greatest, ratio);
    }
    if (!std::isfinite(least)) continue;
    // The requested stiffness, always well damped: at least critically, and as in an implicit Euler
    // step if that is not resolved.
    const double critical = pull.frequency > 0 ? 2 * pull.stiffness / pull.frequency : 0.0;
    const double damping = least > 0 ? std::max(critical, pull.stiffness * in.seconds) : 0.0;
    active.stiffness = pull.stiffness + damping * greatest;
    const Vec4 force = -padded(pull.stiffness * place + damping * velocity);
    for (std::size_t k = 0; k < 4; ++k)
      if (active.weights[k] > 0) {
        right_[active.rows[k]] += active.weights[k] * force;
        inverse_[active.rows[k]] += active.weights[k] * active.weights[k] * active.stiffness;
      }
    pulls_.push_back(active);
  }
}

void CouplingSolver::multiply(const std::vector<Vec4>& x, std::vector<Vec4>& product) const {
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    Vec4 sum = diagonal_[i] * x[i];
    for (Index e = first_[i]; e < first_[i + 1]; ++e)
      sum -= entries_[e].value * x[entries_[e].column];
    product[i] = sum;
  }
  for (const ActivePull& pull : pulls_) {
    Vec4 sum = Vec4::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      if (pull.weights[k] > 0) sum += pull.weights[k] * x[pull.rows[k]];
    sum *= pull.stiffness;
    for (std::size_t k = 0; k < 4; ++k)
      if (pull.weights[k] > 0) product[pull.rows[k]] += pull.weights[k] * sum;
  }
}

int CouplingSolver::solve(const Inputs& in, std::span<Vec3d> corrections) {
  const std::size_t rows = in.active.size();
  assemble(in);
  inverse_.assign(diagonal_.begin(), diagonal_.end());
  assemble_pulls(in);
  for (double& value : inverse_) value = 1 / value;
  x_.resize(rows);
  residual_.resize(rows);
  direction_.resize(rows);
  product_.resize(rows);

  Vec4 sums = Vec4::Zero();
  for (std::size_t i = 0; i < rows; ++i) sums += inverse_[i] * right_[i].cwiseProduct(right_[i]);
  const double scale = total(sums);
  if (!(scale > 0)) {
    for (const Index p : in.active) corrections[p].setZero();
    return 0;
  }
  for (std::size_t i = 0; i < rows; ++i) x_[i] = padded(corrections[in.active[i]]);
  multiply(x_, product_);
  sums.setZero();
  for (std::size_t i = 0; i < rows; ++i) {
    residual_[i] = right_[i] - product_[i];
    direction_[i] = inverse_[i] * residual_[i];
    sums += residual_[i].cwiseProduct(direction_[i]);
  }
  double error = total(sums);
  const double enough = kCouplingResidual * kCouplingResidual * scale;
  const int most = 60 + 3 * static_cast<int>(rows);
  int iterations = 0;
  for (; iterations < most && error > enough; ++iterations) {
    multiply(direction_, product_);
    sums.setZero();
    for (std::size_t i = 0; i < rows; ++i) sums += direction_[i].cwiseProduct(product_[i]);
    const double along = total(sums);
    if (!(along > 0)) break;
    const double by = error / along;
    sums.setZero();
    for (std::size_t i = 0; i < rows; ++i) {
      x_[i] += by * direction_[i];
      residual_[i] -= by * product_[i];
      sums += inverse_[i] * residual_[i].cwiseProduct(residual_[i]);
    }
    const double next = total(sums);
    const double keep = next / error;
    error = next;
    for (std::size_t i = 0; i < rows; ++i)
      direction_[i] = inverse_[i] * residual_[i] + keep * direction_[i];
  }
  for (std::size_t i = 0; i < rows; ++i) corrections[in.active[i]] = x_[i].head<3>();
  return iterations;
}

}  // namespace sunder::particles
