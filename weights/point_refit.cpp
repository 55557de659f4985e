#include "weights/internal/point_refit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/internal/ordered.h"
#include "weights/refit_terms.h"
#include "weights/simplex_solver.h"
#include "weights/symmetric_solve.h"

namespace sunder {
namespace {

/// Weights and bind position are solved for in turn until a turn gains less than this fraction, at
/// most kMostTurns times.
constexpr double kLeastGain = 1e-4;
constexpr int kMostTurns = 32;
/// Growth of the step after each turn that gained.
constexpr double kGrowth = 1.5;
/// Turns taken to find out which bone is missed least.
constexpr int kTurnsOfChoice = 2;

/// A regularised fit is accepted if its mean square is at most this many times that of the
/// unregularised one: 1 % of the root mean square.
constexpr double kWorth = 1.02;

using Vec4 = Eigen::Vector4d;

/// The quadratic forms of one point. Positions are about the centre of the moments.
class PointForms {
 public:
  void begin(const AnimationPoint& exact, const PoseMoments& moments);

  [[nodiscard]] const PoseMoments& moments() const { return *moments_; }
  [[nodiscard]] double per_pose() const { return per_pose_; }
  [[nodiscard]] std::span<const AnimationPoint::Term> terms() const { return terms_; }
  [[nodiscard]] std::size_t count() const { return terms_.size(); }
  /// H_ij or its transpose, times the number of poses; j >= i.
  [[nodiscard]] const PoseMoments::Matrix& between(std::size_t i, std::size_t j) const {
    return *between_[i * terms_.size() + j];
  }
  /// sum_j H_ij q_j.
  [[nodiscard]] const Vec4& towards(std::size_t i) const { return towards_[i]; }
  [[nodiscard]] double target_square() const { return target_square_; }

  /// The bind position with the least mean square error for some weights.
  /// @param stiffness  cost per squared distance from `start`.
  [[nodiscard]] Eigen::Vector3d best_position(std::span<const double> of_terms,
                                              const Eigen::Vector3d& start, double stiffness) const;

 private:
  const PoseMoments* moments_ = nullptr;
  std::vector<AnimationPoint::Term> terms_;
  std::vector<const PoseMoments::Matrix*> between_;
  std::vector<Vec4, Eigen::aligned_allocator<Vec4>> towards_;
  double target_square_ = 0;
  double per_pose_ = 1;
};

void PointForms::begin(const AnimationPoint& exact, const PoseMoments& moments) {
  moments_ = &moments;
  per_pose_ = 1.0 / static_cast<double>(std::max<std::size_t>(moments.pose_count(), 1));
  weights::centre_terms(exact, moments, terms_);
  const std::size_t n = terms_.size();
  between_.resize(n * n);
  towards_.assign(n, Vec4::Zero());
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      const bool is_turned = terms_[i].slot > terms_[j].slot;
      const PoseMoments::Matrix& moment =
          moments.of(terms_[is_turned ? j : i].slot, terms_[is_turned ? i : j].slot);
      between_[i * n + j] = &moment;
      const Vec4 qi = terms_[i].q, qj = terms_[j].q;
      if (is_turned) {
        towards_[i] += multiply(moment.transpose(), qj);
        if (i != j) towards_[j] += multiply(moment, qi);
      } else {
        towards_[i] += multiply(moment, qj);
        if (i != j) towards_[j] += multiply(moment.transpose(), qi);
      }
    }
  target_square_ = 0;
  for (std::size_t i = 0; i < n; ++i) {
    towards_[i] *= per_pose_;
    target_square_ += dot(terms_[i].q, towards_[i]);
  }
}

Eigen::Vector3d PointForms::best_position(std::span<const double> of_terms,
                                          const Eigen::Vector3d& start, double stiffness) const {
  Eigen::Matrix4d square = Eigen::Matrix4d::Zero();
  Vec4 towards = Vec4::Zero();
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (of_terms[i] == 0) continue;
    towards += of_terms[i] * towards_[i];
    for (std::size_t j = i; j < terms_.size(); ++j)
      if (of_terms[j] != 0)
        square += (i == j ? 1.0 : 2.0) * of_terms[i] * of_terms[j] * between(i, j);
  }
  square = (0.5 * per_pose_) * (square + square.transpose()).eval();
  Eigen::Matrix3d left = square.topLeftCorner<3, 3>();
  left.diagonal().array() += stiffness + 1e-280;
  const Eigen::Vector3d right =
      towards.head<3>() - square.topRightCorner<3, 1>() + stiffness * start;
  const Eigen::Vector3d best = weights::solve_symmetric(left, right);
  return best.allFinite() ? best : start;
}

}  // namespace

/// The fit of one point, and the memory for it. Positions are about the centre of the moments.
class PointRefit::Problem {
 public:
  void begin(const PointToRefit& point, const PoseMoments& moments);
  [[nodiscard]] Fit solve(const PointToRefit& point, const Options& options);

 private:
  void set_position(const Eigen::Vector3d& position);
  void improve(const Options& options, const Eigen::Vector3d& start, Eigen::Vector3d& position);
  void remove_restraint();
  void restrain_where_cheap(const Options& options, const Eigen::Vector3d& start,
                            Eigen::Vector3d& position);
  [[nodiscard]] double mean_square(const std::vector<double>& of_terms,
                                   const Eigen::Vector3d& position);
  [[nodiscard]] bool drop_influences(std::size_t maximum, int turns, const Eigen::Vector3d& start,
                                     Eigen::Vector3d& position);
  void alternate(int most, const Eigen::Vector3d& start, Eigen::Vector3d& position);

  PointForms forms_;
  std::vector<AnimationPoint::Term> difference_;
  weights::Restraint restraint_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();  ///< Of the last set_position().
  double tie_ = 0;                                      ///< Added to the solver's diagonal.
  weights::SimplexSolver solver_;
  std::vector<bool> allowed_;
  std::vector<double> start_, weights_;  ///< Per term.
  std::vector<Influence> influences_;
  /// Memory of single functions.
  struct Scratch {
    std::vector<double> restrained, unrestrained, before, best, earlier, projected;
  } scratch_;
};

PointRefit::PointRefit() : problem_(std::make_unique<Problem>()) {}
PointRefit::~PointRefit() = default;

PointRefit::Fit PointRefit::fit(const PointToRefit& point, const Options& options,
                                const PoseMoments& moments) {
  problem_->begin(point, moments);
  return problem_->solve(point, options);
}

void PointRefit::Problem::begin(const PointToRefit& point, const PoseMoments& moments) {
  forms_.begin(*point.exact, moments);
  weights::weights_of_terms(forms_.terms(), point.barycentric, start_);
  restraint_ = weights::restraint_of(forms_.terms(), point.position - moments.centre(), moments);
  weights_ = start_;
  allowed_.assign(forms_.count(), true);
}

/// Fills the solver with the squares and products of the errors of each bone alone; because the
/// weights sum to one, the target can be subtracted from each.
void PointRefit::Problem::set_position(const Eigen::Vector3d& position) {
  const std::size_t n = forms_.count();
  const Vec4 at(position.x(), position.y(), position.z(), 1.0);
  solver_.resize(n);
  scratch_.projected.resize(n);
  for (std::size_t i = 0; i < n; ++i) scratch_.projected[i] = dot(at, forms_.towards(i));
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      const double product = forms_.per_pose() * dot(at, multiply(forms_.between(i, j), at));
      if (i == j) largest = std::max(largest, product);
      solver_.gram(i, j) = solver_.gram(j, i) =
          product - scratch_.projected[i] - scratch_.projected[j] + forms_.target_square();
    }
  // Where bones move alike, or nearly so, the initial weights decide between them.
  tie_ = 1e-13 * largest + restraint_.of_weights + 1e-280;
  for (std::size_t i = 0; i < n; ++i) {
    solver_.gram(i, i) += tie_;
    solver_.linear(i) = tie_ * start_[i];
  }
  position_ = position;
}

double PointRefit::Problem::mean_square(const std::vector<double>& of_terms,
                                        const Eigen::Vector3d& position) {
  if (position != position_)
    return weights::mean_square(forms_.terms(), of_terms, position, forms_.moments(), difference_);
  double sum = 0;
  for (std::size_t i = 0; i < forms_.count(); ++i) {
    double row = -tie_ * of_terms[i];
    for (std::size_t j = 0; j < forms_.count(); ++j) row += solver_.gram(i, j) * of_terms[j];
    sum += of_terms[i] * row;
  }
  return std::max(sum, 0.0);
}

/// Reduces the number of positive weights to `maximum`, each time dropping the one that is missed
/// least. 0: no limit.
/// @param turns  turns of alternate() without each candidate before its loss is known. 0: the bind
///         position stays.
/// @return whether any weight was dropped.
bool PointRefit::Problem::drop_influences(std::size_t maximum, int turns,
                                          const Eigen::Vector3d& start, Eigen::Vector3d& position) {
  const auto used = [&] {
    return static_cast<std::size_t>(
        std::count_if(weights_.begin(), weights_.end(), [](double w) { return w > 0; }));
  };
  if (maximum == 0 || used() <= maximum) return false;
  while (used() > maximum) {
    double least = 0;
    std::size_t dropped = forms_.count();
    scratch_.before = weights_;
    const Eigen::Vector3d from = position;
    for (std::size_t i = 0; i < forms_.count(); ++i) {
      if (!(scratch_.before[i] > 0)) continue;
      for (std::size_t j = 0; j < forms_.count(); ++j)
        allowed_[j] = j != i && scratch_.before[j] > 0;
      weights_ = scratch_.before;
      weights_[i] = 0;
      // Summed instead of 1 - before[i], which would be 0 if that weight is almost one.
      const double rest = std::accumulate(weights_.begin(), weights_.end(), 0.0);
      for (double& weight : weights_) weight /= rest;
      Eigen::Vector3d moved = from;
      if (turns > 0) set_position(moved);
      solver_.solve(weights_, allowed_);
      alternate(turns, start, moved);
      const double value = solver_.value(weights_);
      if (dropped < forms_.count() && !(value < least)) continue;
      least = value;
      dropped = i;
      scratch_.best = weights_;
      position = moved;
    }
    weights_ = scratch_.best;
  }
  for (std::size_t i = 0; i < forms_.count(); ++i) allowed_[i] = weights_[i] > 0;
  return true;
}

/// At most `most` turns, from weights that are optimal for the current bind position. While turns
/// gain, each step of the bind position overshoots the optimum for the current weights farther;
/// plain alternation would creep along valleys.
void PointRefit::Problem::alternate(int most, const Eigen::Vector3d& start,
                                    Eigen::Vector3d& position) {
  if (most == 0) return;
  double before = mean_square(weights_, position), stride = 1;
  for (int turn = 0; turn < most; ++turn) {
    const Eigen::Vector3d from = position;
    scratch_.earlier = weights_;
    position += stride * (forms_.best_position(weights_, start, restraint_.of_position) - position);
    set_position(position);
    solver_.solve(weights_, allowed_);
    const double after = mean_square(weights_, position);
    const bool gains = after < (1 - kLeastGain) * before;
    if (!gains && stride == 1) return;
    if (!(after < before)) {
      position = from;
      weights_ = scratch_.earlier;
      set_position(position);
    } else {
      before = after;
    }
    stride = gains ? kGrowth * stride : 1;
  }
}

/// Starts from the current weights and the position that was set last.
void PointRefit::Problem::improve(const Options& options, const Eigen::Vector3d& start,
                                  Eigen::Vector3d& position) {
  allowed_.assign(forms_.count(), true);
  solver_.solve(weights_, allowed_);
  const int turns = options.moves_bind ? kMostTurns : 0;
  alternate(turns, start, position);
  if (drop_influences(options.maximum_influences, std::min(turns, kTurnsOfChoice), start, position))
    alternate(turns, start, position);
}

/// From here on, weights and bind position change at no cost.
void PointRefit::Problem::remove_restraint() {
  for (std::size_t i = 0; i < forms_.count(); ++i) {
    solver_.gram(i, i) -= restraint_.of_weights;
    solver_.linear(i) -= restraint_.of_weights * start_[i];
  }
  tie_ -= restraint_.of_weights;
  restraint_ = {};
}

/// Replaces the restrained fit, which was just made, by the most restrained one that costs next to
/// nothing.
void PointRefit::Problem::restrain_where_cheap(const Options& options, const Eigen::Vector3d& start,
                                               Eigen::Vector3d& position) {
  const weights::Restraint whole = restraint_;
  const Eigen::Vector3d held_position = position;
  scratch_.restrained = weights_;
  remove_restraint();
  const double held_back = mean_square(weights_, position);
  improve(options, start, position);
  const double most = kWorth * mean_square(weights_, position);
  const Eigen::Vector3d free_position = position;
  scratch_.unrestrained = weights_;
  position = held_position;
  weights_ = scratch_.restrained;
  if (held_back <= most) return;
  for (const double part : {0.1, 0.01}) {
    if (!options.moves_bind) break;  // fitting weights alone has to be fast
    restraint_ = {part * whole.of_position, part * whole.of_weights};
    set_position(position);
    improve(options, start, position);
    if (mean_square(weights_, position) <= most) return;
    position = held_position;
    weights_ = scratch_.restrained;
  }
  position = free_position;
  weights_ = scratch_.unrestrained;
}

PointRefit::Fit PointRefit::Problem::solve(const PointToRefit& point, const Options& options) {
  const Eigen::Vector3d start = point.position - forms_.moments().centre();
  Fit result;
  result.position = point.position;
  result.influences = point.barycentric;
  Eigen::Vector3d position = start;
  set_position(position);
  result.barycentric_mean_square = result.mean_square = mean_square(start_, start);
  improve(options, start, position);
  restrain_where_cheap(options, start, position);
  weights::store_weights(forms_.terms(), weights_, influences_);
  // Only the stored weights count.
  weights::weights_of_terms(forms_.terms(), influences_, weights_);
  const double after = mean_square(weights_, position);
  if (!(after < result.barycentric_mean_square)) return result;
  result.mean_square = after;
  result.influences = influences_;
  result.position = Eigen::Vector3d(position + Eigen::Vector3d(forms_.moments().centre()));
  result.is_better = true;
  return result;
}

}  // namespace sunder
