#include "skinning/animation/pull_solver.h"

#include <algorithm>
#include <cmath>

#include "core/internal/elementary.h"
#include "skinning/internal/rotation.h"

namespace sunder::animation {
namespace {

/// Damping relative to the mean of the matrix's diagonal: at first, least, most, and its factors
/// after a step that helped and one that did not.
constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-9, kMostDamping = 1e6;
constexpr double kLessDamping = 0.2, kMoreDamping = 6.0;
/// Radians: largest turn of a joint in one step, for the derivative holds nearby only.
constexpr double kLargestTurn = 0.6;
/// Radians: the turn that tests whether a limit is in the way, and the one that leaves a straight
/// chain.
constexpr double kProbe = 1e-3, kBend = 0.35;
/// Steps that reduce the error by a smaller part than this, so many in a row, end an attempt.
constexpr double kSlow = 1e-5;
constexpr int kMostSlowSteps = 3;
/// The search goes on until the error is this part of the tolerance, so that rounding to float does
/// not leave it.
constexpr double kMargin = 0.9;

/// A random number in [-1, 1), the same one on every machine (splitmix64).
double next_random(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return 2.0 * static_cast<double>(z >> 11) * 0x1p-53 - 1.0;
}

Vec3d perpendicular_to(const Vec3d& direction) {
  Eigen::Index least = 0;
  direction.cwiseAbs().minCoeff(&least);
  Vec3d axis = Vec3d::Zero();
  axis[least] = 1.0;
  return normalized(direction.cross(axis));
}

}  // namespace

double PullSolver::solve(PullChain& chain, const PullOptions& options) {
  iterations_ = 0;
  double error = descend(chain, chain.measure(), options);
  save(chain, best_);
  for (std::uint32_t attempt = 1; attempt < options.attempts; ++attempt) {
    if (error <= kMargin * options.tolerance || chain.active().empty()) break;
    chain.differentiate();
    if (chain.is_stretched()) break;
    if (attempt == 1)
      bend(chain);
    else
      scatter(chain, attempt);
    const double found = descend(chain, chain.measure(), options);
    if (found < error) {
      error = found;
      save(chain, best_);
    }
    restore(chain, best_);
  }
  chain.measure();
  return error;
}

double PullSolver::descend(PullChain& chain, double error, const PullOptions& options) {
  damping_ = kFirstDamping;
  may_hold_ = true;
  int slow_steps = 0;
  for (std::uint32_t i = 0; i < options.iterations; ++i) {
    if (error <= kMargin * options.tolerance || slow_steps == kMostSlowSteps) break;
    const double before = error;
    ++iterations_;
    if (!step(chain, error)) {
      if (!may_hold_) break;
      may_hold_ = false;  // A held joint may be needed after all.
      damping_ = kFirstDamping;
      continue;
    }
    may_hold_ = true;
    slow_steps = before - error < kSlow * before ? slow_steps + 1 : 0;
  }
  return error;
}

/// One step that makes the error smaller. @return false if none was found; nothing changed then.
bool PullSolver::step(PullChain& chain, double& error) {
  chain.differentiate();
  hold_joints(chain);
  find_columns(chain);
  add_matrix(chain);
  save(chain, before_);
  errors_.assign(chain.errors().begin(), chain.errors().end());  // Trials overwrite the chain's.
  for (; damping_ <= kMostDamping; damping_ *= kMoreDamping) {
    if (!find_turns(chain)) continue;
    turn(chain);
    const double found = chain.measure();
    if (found < error) {
      error = found;
      damping_ = std::max(damping_ * kLessDamping, kLeastDamping);
      return true;
    }
    restore(chain, before_);
  }
  damping_ = kFirstDamping;
  chain.measure();
  return false;
}

/// Leaves joints out that would have to go on beyond a limit, so that the others do the work.
void PullSolver::hold_joints(const PullChain& chain) {
  const auto active = chain.active();
  is_held_.assign(active.size(), false);
  if (!may_hold_) return;
  for (std::size_t j = 0; j < active.size(); ++j) {
    const JointRange& range = chain.joint(active[j]).range;
    if (range.is_free()) continue;
    Vec3d downhill = Vec3d::Zero();
    for (std::size_t t = 0; t < chain.target_count(); ++t)
      downhill += multiply(chain.derivative(t, j).transpose(), chain.errors()[t]);
    if (range.is_hinge()) {
      const Vec3d axis = range.axis_in_parent();
      downhill = dot(downhill, axis) * axis;
    }
    const double size = norm(downhill);
    if (!(size > 0.0)) continue;
    const Quatd& now = chain.rotation(active[j]);
    const Quatd then = range.turned(now, Vec3d(downhill * (kProbe / size)));
    // The angle between two unit quaternions is twice that of the 4-vectors.
    const Vec4d chord = then.coeffs() - now.coeffs(), other = then.coeffs() + now.coeffs();
    is_held_[j] = 2.0 * std::min(norm(chord), norm(other)) < 0.5 * kProbe;
  }
}

void PullSolver::find_columns(const PullChain& chain) {
  const auto active = chain.active();
  columns_.clear();
  for (std::uint32_t j = 0; j < active.size(); ++j) {
    if (is_held_[j]) continue;
    const JointRange& range = chain.joint(active[j]).range;
    if (range.is_hinge()) {
      columns_.push_back({j, range.axis_in_parent()});
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) columns_.push_back({j, Vec3d::Unit(axis)});
  }
}

/// J W J^T, lower triangle. W: how readily each joint turns.
void PullSolver::add_matrix(const PullChain& chain) {
  const std::size_t rows = 3 * chain.target_count();
  entries_.resize(rows * columns_.size());
  matrix_.assign(rows * rows, 0.0);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const Column& column = columns_[c];
    double* const entries = entries_.data() + rows * c;
    for (std::size_t t = 0; t < chain.target_count(); ++t) {
      const Vec3d moved = multiply(chain.derivative(t, column.joint), column.axis);
      for (int i = 0; i < 3; ++i) entries[3 * t + static_cast<std::size_t>(i)] = moved[i];
    }
    const double readiness = chain.joint(chain.active()[column.joint]).readiness;
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t other = 0; other <= row; ++other)
        matrix_[row * rows + other] += readiness * entries[row] * entries[other];
  }
}

/// Cholesky's factor of the damped matrix. @return false if it is not positive definite.
bool PullSolver::factorise(double damping) {
  const std::size_t rows = right_.size();
  factor_ = matrix_;
  for (std::size_t i = 0; i < rows; ++i) {
    factor_[i * rows + i] += damping;
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = factor_[i * rows + j];
      for (std::size_t k = 0; k < j; ++k) sum -= factor_[i * rows + k] * factor_[j * rows + k];
      if (i != j) {
        factor_[i * rows + j] = sum / factor_[j * rows + j];
      } else {
        if (!(sum > 0.0) || !std::isfinite(sum)) return false;
        factor_[i * rows + i] = std::sqrt(sum);
      }
    }
  }
  return true;
}

/// turns = W J^T (J W J^T + damping)^-1 errors.
bool PullSolver::find_turns(const PullChain& chain) {
  const std::size_t rows = 3 * chain.target_count();
  right_.resize(rows);
  double diagonal = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    right_[i] = errors_[i / 3][static_cast<Eigen::Index>(i % 3)];
    diagonal += matrix_[i * rows + i];
  }
  if (!factorise(damping_ * diagonal / static_cast<double>(rows))) return false;
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < i; ++k) right_[i] -= factor_[i * rows + k] * right_[k];
    right_[i] /= factor_[i * rows + i];
  }
  for (std::size_t i = rows; i-- > 0;) {
    for (std::size_t k = i + 1; k < rows; ++k) right_[i] -= factor_[k * rows + i] * right_[k];
    right_[i] /= factor_[i * rows + i];
  }
  turns_.assign(chain.active().size(), Vec3d::Zero());
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    double along = 0;
    for (std::size_t i = 0; i < rows; ++i) along += entries_[rows * c + i] * right_[i];
    const std::uint32_t joint = columns_[c].joint;
    turns_[joint] += chain.joint(chain.active()[joint]).readiness * along * columns_[c].axis;
  }
  double largest = 0;
  for (const Vec3d& turn : turns_) largest = std::max(largest, norm(turn));
  if (!std::isfinite(largest)) return false;
  if (largest > kLargestTurn)
    for (Vec3d& turn : turns_) turn *= kLargestTurn / largest;
  return largest > 0.0;
}

void PullSolver::turn(PullChain& chain) const {
  const auto active = chain.active();
  for (std::size_t j = 0; j < active.size(); ++j) {
    if (is_held_[j]) continue;
    const std::uint32_t node = active[j];
    chain.set_rotation(node, chain.joint(node).range.turned(chain.rotation(node), turns_[j]));
  }
}

/// Turns the joints to and fro about one axis across the line to the target: a straight chain has
/// no derivative along itself, and a bent one can become shorter.
void PullSolver::bend(PullChain& chain) const {
  Vec3d direction = Vec3d::Zero();
  for (const Vec3d& error : chain.errors()) direction += error;
  const Vec3d across = perpendicular_to(normalized(direction));
  double angle = kBend;
  for (const std::uint32_t node : chain.active()) {
    const JointRange& range = chain.joint(node).range;
    const Vec3d axis =
        range.is_hinge()
            ? range.axis_in_parent()
            : normalized(Vec3d(multiply(chain.model_from_parent(node).transpose(), across)));
    const Quatd before = chain.rotation(node);
    Quatd after = range.turned(before, Vec3d(angle * axis));
    // At a limit it bends the other way.
    if (std::abs(dot(after.coeffs(), before.coeffs())) > elementary::cos(0.25 * kBend))
      after = range.turned(before, Vec3d(-angle * axis));
    chain.set_rotation(node, after);
    angle = angle > 0 ? -2.0 * kBend : 2.0 * kBend;
  }
}

/// Random turns, larger ones in later attempts.
void PullSolver::scatter(PullChain& chain, std::uint32_t attempt) {
  std::uint64_t state = attempt;
  const double size = std::min(0.5 * attempt, 3.0);
  for (const std::uint32_t node : chain.active()) {
    const double x = next_random(state), y = next_random(state), z = next_random(state);
    const JointRange& range = chain.joint(node).range;
    Vec3d turn = size * Vec3d(x, y, z);
    if (range.is_hinge()) turn = size * x * range.axis_in_parent();
    chain.set_rotation(node, range.turned(chain.rotation(node), turn));
  }
}

void PullSolver::save(const PullChain& chain, std::vector<Quatd>& rotations) {
  rotations.clear();
  for (const std::uint32_t node : chain.active()) rotations.push_back(chain.rotation(node));
}

void PullSolver::restore(PullChain& chain, const std::vector<Quatd>& rotations) {
  const auto active = chain.active();
  for (std::size_t j = 0; j < active.size(); ++j) chain.set_rotation(active[j], rotations[j]);
}

}  // namespace sunder::animation
