#include "weights/internal/point_refit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "weights/refit_terms.h"
#include "weights/simplex_solver.h"

namespace sunder {
namespace {

/// Weights and bind position take turns until a turn gains less than this part, or so many times.
constexpr double kLeastGain = 1e-4;
constexpr int kMostTurns = 32;
/// How much farther a turn goes after each one that gained.
constexpr double kGrowth = 1.5;
/// So many tell which bone is missed least.
constexpr int kTurnsOfChoice = 2;

/// A fit that is held back is taken where its mean square is no larger than this many times that of
/// one that is not: 1 % of the root mean square.
constexpr double kWorth = 1.02;

}  // namespace

/// One point's quadratic forms, and the memory for them. Places are about the centre of the
/// moments.
class PointRefit::Problem {
 public:
  void begin(const PointToRefit& point, const PoseMoments& moments);
  [[nodiscard]] Fit solve(const PointToRefit& point, const Options& options);

 private:
  using Vec4 = Eigen::Vector4d;

  /// H_ij or its transpose, times the number of poses; j not below i.
  [[nodiscard]] const PoseMoments::Matrix& between(std::size_t i, std::size_t j) const {
    return *between_[i * terms_.size() + j];
  }

  void set_position(const Eigen::Vector3d& position);
  void improve(const Options& options, const Eigen::Vector3d& start, Eigen::Vector3d& position);
  void let_go();
  void hold_back_as_far_as_it_is_worth(const Options& options, const Eigen::Vector3d& start,
                                       Eigen::Vector3d& position);
  [[nodiscard]] Eigen::Vector3d best_position(const Eigen::Vector3d& start) const;
  [[nodiscard]] double mean_square(const std::vector<double>& of_terms,
                                   const Eigen::Vector3d& position);
  [[nodiscard]] bool choose(std::size_t maximum, int turns, const Eigen::Vector3d& start,
                            Eigen::Vector3d& position);
  void take_turns(int most, const Eigen::Vector3d& start, Eigen::Vector3d& position);

  const PoseMoments* moments_ = nullptr;
  std::vector<AnimationPoint::Term> terms_, difference_;
  std::vector<const PoseMoments::Matrix*> between_;
  std::vector<Vec4, Eigen::aligned_allocator<Vec4>> towards_;  ///< sum_j H_ij q_j.
  double target_square_ = 0;
  weights::Restraint restraint_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();  ///< That was set.
  double tie_ = 0;                                      ///< On the solver's diagonal.
  double per_pose_ = 1;
  weights::SimplexSolver solver_;
  std::vector<bool> allowed_;
  std::vector<double> start_, weights_, held_weights_, free_weights_, before_, best_, candidate_,
      earlier_;
  std::vector<Influence> influences_;
};

PointRefit::PointRefit() : problem_(std::make_unique<Problem>()) {}
PointRefit::~PointRefit() = default;

PointRefit::Fit PointRefit::fit(const PointToRefit& point, const Options& options,
                                const PoseMoments& moments) {
  problem_->begin(point, moments);
  return problem_->solve(point, options);
}

void PointRefit::Problem::begin(const PointToRefit& point, const PoseMoments& moments) {
  moments_ = &moments;
  per_pose_ = 1.0 / static_cast<double>(std::max<std::size_t>(moments.pose_count(), 1));
  weights::centre_terms(*point.exact, moments, terms_);
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
        towards_[i].noalias() += moment.transpose() * qj;
        if (i != j) towards_[j].noalias() += moment * qi;
      } else {
        towards_[i].noalias() += moment * qj;
        if (i != j) towards_[j].noalias() += moment.transpose() * qi;
      }
    }
  target_square_ = 0;
  for (std::size_t i = 0; i < n; ++i) {
    towards_[i] *= per_pose_;
    target_square_ += terms_[i].q.dot(towards_[i]);
  }
  weights::weights_of_terms(terms_, point.barycentric, start_);
  restraint_ = weights::restraint_of(terms_, point.position - moments.centre(), moments);
  weights_ = start_;
  allowed_.assign(n, true);
}

/// Squares and products of what each bone alone would be off by: sum w = 1 lets the target be taken
/// from each.
void PointRefit::Problem::set_position(const Eigen::Vector3d& position) {
  const std::size_t n = terms_.size();
  const Vec4 at(position.x(), position.y(), position.z(), 1.0);
  solver_.resize(n);
  candidate_.resize(n);
  for (std::size_t i = 0; i < n; ++i) candidate_[i] = at.dot(towards_[i]);
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      const double product = per_pose_ * at.dot(between(i, j) * at);
      if (i == j) largest = std::max(largest, product);
      solver_.gram(i, j) = solver_.gram(j, i) =
          product - candidate_[i] - candidate_[j] + target_square_;
    }
  // Bones that move alike, or nearly: what tells them apart is where the weights were.
  tie_ = 1e-13 * largest + restraint_.of_weights + 1e-280;
  for (std::size_t i = 0; i < n; ++i) {
    solver_.gram(i, i) += tie_;
    solver_.linear(i) = tie_ * start_[i];
  }
  position_ = position;
}

Eigen::Vector3d PointRefit::Problem::best_position(const Eigen::Vector3d& start) const {
  Eigen::Matrix4d square = Eigen::Matrix4d::Zero();
  Vec4 towards = Vec4::Zero();
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (weights_[i] == 0) continue;
    towards += weights_[i] * towards_[i];
    for (std::size_t j = i; j < terms_.size(); ++j)
      if (weights_[j] != 0)
        square += (i == j ? 1.0 : 2.0) * weights_[i] * weights_[j] * between(i, j);
  }
  square = (0.5 * per_pose_) * (square + square.transpose()).eval();
  const double stiffness = restraint_.of_position;
  Eigen::Matrix3d left = square.topLeftCorner<3, 3>();
  left.diagonal().array() += stiffness + 1e-280;
  const Eigen::Vector3d right =
      towards.head<3>() - square.topRightCorner<3, 1>() + stiffness * start;
  const Eigen::Vector3d best = left.ldlt().solve(right);
  return best.allFinite() ? best : start;
}

double PointRefit::Problem::mean_square(const std::vector<double>& of_terms,
                                        const Eigen::Vector3d& position) {
  if (position != position_)
    return weights::mean_square(terms_, of_terms, position, *moments_, difference_);
  double sum = 0;  // of what is at hand already, without what holds back
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    double row = -tie_ * of_terms[i];
    for (std::size_t j = 0; j < terms_.size(); ++j) row += solver_.gram(i, j) * of_terms[j];
    sum += of_terms[i] * row;
  }
  return std::max(sum, 0.0);
}

/// Leaves no more than `maximum` weights: without that one which is missed least, and so on. 0: as
/// many as there are.
/// @param turns  how many are taken without each of them before it is known how much it is missed.
/// 0: the bind position stays.
/// @return whether any had to go.
bool PointRefit::Problem::choose(std::size_t maximum, int turns, const Eigen::Vector3d& start,
                                 Eigen::Vector3d& position) {
  const auto used = [&] {
    return static_cast<std::size_t>(
        std::count_if(weights_.begin(), weights_.end(), [](double w) { return w > 0; }));
  };
  if (maximum == 0 || used() <= maximum) return false;
  while (used() > maximum) {
    double least = 0;
    std::size_t dropped = terms_.size();
    before_ = weights_;
    const Eigen::Vector3d from = position;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (!(before_[i] > 0)) continue;
      for (std::size_t j = 0; j < terms_.size(); ++j) allowed_[j] = j != i && before_[j] > 0;
      weights_ = before_;
      weights_[i] = 0;
      // Added up, not 1 - before_[i]: beside a weight of almost one that would be nothing.
      const double rest = std::accumulate(weights_.begin(), weights_.end(), 0.0);
      for (double& weight : weights_) weight /= rest;
      Eigen::Vector3d moved = from;
      if (turns > 0) set_position(moved);
      solver_.solve(weights_, allowed_);
      take_turns(turns, start, moved);
      const double value = solver_.value(weights_);
      if (dropped < terms_.size() && !(value < least)) continue;
      least = value;
      dropped = i;
      best_ = weights_;
      position = moved;
    }
    weights_ = best_;
  }
  for (std::size_t i = 0; i < terms_.size(); ++i) allowed_[i] = weights_[i] > 0;
  return true;
}

/// At most so many, from weights that are the best where the bind position is. While turns gain,
/// the bind position goes farther and farther past the best one for the weights as they are; step
/// by step the two would creep along valleys.
void PointRefit::Problem::take_turns(int most, const Eigen::Vector3d& start,
                                     Eigen::Vector3d& position) {
  if (most == 0) return;
  double before = mean_square(weights_, position), stride = 1;
  for (int turn = 0; turn < most; ++turn) {
    const Eigen::Vector3d from = position;
    earlier_ = weights_;
    position += stride * (best_position(start) - position);
    set_position(position);
    solver_.solve(weights_, allowed_);
    const double after = mean_square(weights_, position);
    const bool gains = after < (1 - kLeastGain) * before;
    if (!gains && stride == 1) return;
    if (!(after < before)) {
      position = from;
      weights_ = earlier_;
      set_position(position);
    } else {
      before = after;
    }
    stride = gains ? kGrowth * stride : 1;
  }
}

/// From the weights as they are, and the position that was set.
void PointRefit::Problem::improve(const Options& options, const Eigen::Vector3d& start,
                                  Eigen::Vector3d& position) {
  allowed_.assign(terms_.size(), true);
  solver_.solve(weights_, allowed_);
  const int turns = options.moves_bind ? kMostTurns : 0;
  take_turns(turns, start, position);
  if (choose(options.maximum_influences, std::min(turns, kTurnsOfChoice), start, position))
    take_turns(turns, start, position);
}

/// Weights and bind position may change at no cost from here on.
void PointRefit::Problem::let_go() {
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    solver_.gram(i, i) -= restraint_.of_weights;
    solver_.linear(i) -= restraint_.of_weights * start_[i];
  }
  tie_ -= restraint_.of_weights;
  restraint_ = {};
}

/// From the fit that is held back, which was just made, to one that is held back as much as costs
/// next to nothing.
void PointRefit::Problem::hold_back_as_far_as_it_is_worth(const Options& options,
                                                          const Eigen::Vector3d& start,
                                                          Eigen::Vector3d& position) {
  const weights::Restraint whole = restraint_;
  const Eigen::Vector3d held_position = position;
  held_weights_ = weights_;
  let_go();
  const double held_back = mean_square(weights_, position);
  improve(options, start, position);
  const double most = kWorth * mean_square(weights_, position);
  const Eigen::Vector3d free_position = position;
  free_weights_ = weights_;
  position = held_position;
  weights_ = held_weights_;
  if (held_back <= most) return;
  for (const double part : {0.1, 0.01}) {
    if (!options.moves_bind) break;  // weights alone are for those in a hurry
    restraint_ = {part * whole.of_position, part * whole.of_weights};
    set_position(position);
    improve(options, start, position);
    if (mean_square(weights_, position) <= most) return;
    position = held_position;
    weights_ = held_weights_;
  }
  position = free_position;
  weights_ = free_weights_;
}

PointRefit::Fit PointRefit::Problem::solve(const PointToRefit& point, const Options& options) {
  const Eigen::Vector3d start = point.position - moments_->centre();
  Fit result;
  result.position = point.position;
  result.influences = point.barycentric;
  Eigen::Vector3d position = start;
  set_position(position);
  result.barycentric_mean_square = result.mean_square = mean_square(start_, start);
  improve(options, start, position);
  hold_back_as_far_as_it_is_worth(options, start, position);
  weights::store_weights(terms_, weights_, influences_);
  // What is stored is what has to be better.
  weights::weights_of_terms(terms_, influences_, weights_);
  const double after = mean_square(weights_, position);
  if (!(after < result.barycentric_mean_square)) return result;
  result.mean_square = after;
  result.influences = influences_;
  result.position = Eigen::Vector3d(position + Eigen::Vector3d(moments_->centre()));
  result.is_better = true;
  return result;
}

}  // namespace sunder
