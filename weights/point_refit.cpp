#include "weights/internal/point_refit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/internal/ordered.h"
#include "weights/internal/refit_terms.h"
#include "weights/point_forms.h"
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

/// Attempts to find a fit over some bones that exceeds no bound, and steps to improve one.
constexpr int kMostAttempts = 8;
constexpr int kMostDescents = 8;
/// What a multiplier is raised by if it was too small.
constexpr double kRaise = 3;
/// Share of the longest step that is taken, because stored weights are rounded.
constexpr double kSafety = 1 - 1e-4;

/// A group of poses with a bound, and its multiplier in the objective.
struct Bound {
  weights::PointForms forms;
  std::size_t group = 0;
  double multiplier = 0;
};

}  // namespace

/// The fit of one point, and the memory for it. Positions are about the centre of the moments.
class PointRefit::Problem {
 public:
  void begin(const PointToRefit& point, const Options& options, const PoseMoments& moments);
  [[nodiscard]] Fit solve(const PointToRefit& point, Options options);

 private:
  /// Weights and a bind position, and their value.
  struct State {
    std::vector<double> weights;  ///< Per term.
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    double value = 0;  ///< Of the objective, without restraint.
  };

  void set_position(const Eigen::Vector3d& position);
  void improve(const Options& options);
  void remove_restraint();
  void restrain_where_cheap(const Options& options);
  [[nodiscard]] double cost();
  [[nodiscard]] bool drop_influences(std::size_t maximum, int turns);
  void alternate(int most);
  [[nodiscard]] Eigen::Vector3d best_position() const;

  [[nodiscard]] bool find_excess(const PointToRefit& point, const State& state);
  void keep_bounds(const PointToRefit& point, const Options& options, State& best);
  [[nodiscard]] bool search_multipliers(const PointToRefit& point, int turns, double gain);
  void raise_multipliers(const PointToRefit& point, double gain);
  void raise_multiplier(const PointToRefit& point, std::size_t group, double gain);
  void descend(const PointToRefit& point, State& from);
  [[nodiscard]] double longest_step(const PointToRefit& point, const State& from,
                                    std::size_t& blocking);
  void store(const State& from, State& to);

  const PoseMoments* moments_ = nullptr;
  std::vector<AnimationPoint::Term> terms_, difference_;
  weights::PointForms objective_;
  std::vector<Bound> bounds_;    ///< The first `bound_count_` are in use.
  std::size_t bound_count_ = 0;  ///< Of bounds that were exceeded by an attempt.
  std::vector<double> excess_;   ///< Per bound of the point: its mean square, relative to allowed.
  std::vector<double> excess_before_, excess_of_step_;  ///< Likewise, in longest_step().
  weights::Restraint restraint_;
  Eigen::Vector3d start_position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d of_solver_ = Eigen::Vector3d::Zero();  ///< Of the last set_position().
  double tie_ = 0;                                       ///< Added to the solver's diagonal.
  weights::SimplexSolver solver_;
  std::vector<bool> allowed_;
  std::vector<double> start_, weights_;  ///< Per term.
  std::vector<Influence> influences_;
  State best_, beyond_, between_, stored_;
  /// Memory of single functions.
  struct Scratch {
    std::vector<double> restrained, unrestrained, before, best, earlier;
  } scratch_;
};

PointRefit::PointRefit() : problem_(std::make_unique<Problem>()) {}
PointRefit::~PointRefit() = default;

PointRefit::Fit PointRefit::fit(const PointToRefit& point, const Options& options,
                                const PoseMoments& moments) {
  problem_->begin(point, options, moments);
  return problem_->solve(point, options);
}

void PointRefit::Problem::begin(const PointToRefit& point, const Options& options,
                                const PoseMoments& moments) {
  moments_ = &moments;
  weights::centre_terms(*point.exact, moments, terms_);
  objective_.begin(terms_, moments, options.group);
  weights::weights_of_terms(terms_, point.barycentric, start_);
  start_position_ = position_ = point.position - moments.centre();
  restraint_ = weights::restraint_of(terms_, start_position_, moments, options.group);
  weights_ = start_;
  allowed_.assign(terms_.size(), true);
  bound_count_ = 0;
}

/// Fills the solver.
void PointRefit::Problem::set_position(const Eigen::Vector3d& position) {
  const std::size_t n = terms_.size();
  solver_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) solver_.gram(i, j) = 0;
  double largest = objective_.add_to_gram(position, 1.0, solver_);
  for (std::size_t i = 0; i < bound_count_; ++i)
    largest =
        std::max(largest, bounds_[i].forms.add_to_gram(position, bounds_[i].multiplier, solver_));
  // Where bones move alike, or nearly so, the initial weights decide between them.
  tie_ = 1e-13 * largest + restraint_.of_weights + 1e-280;
  for (std::size_t i = 0; i < n; ++i) {
    solver_.gram(i, i) += tie_;
    solver_.linear(i) = tie_ * start_[i];
  }
  of_solver_ = position;
}

/// The objective with multipliers at the current weights and bind position.
double PointRefit::Problem::cost() {
  if (position_ != of_solver_) {
    double sum = objective_.mean_square(weights_, position_);
    for (std::size_t i = 0; i < bound_count_; ++i)
      sum += bounds_[i].multiplier * bounds_[i].forms.mean_square(weights_, position_);
    return sum;
  }
  double sum = 0;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    double row = -tie_ * weights_[i];
    for (std::size_t j = 0; j < terms_.size(); ++j) row += solver_.gram(i, j) * weights_[j];
    sum += weights_[i] * row;
  }
  return std::max(sum, 0.0);
}

/// The bind position with the least cost for the current weights.
Eigen::Vector3d PointRefit::Problem::best_position() const {
  Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
  left.diagonal().setConstant(restraint_.of_position + 1e-280);
  Eigen::Vector3d right = restraint_.of_position * start_position_;
  objective_.add_to_equations(weights_, 1.0, left, right);
  for (std::size_t i = 0; i < bound_count_; ++i)
    bounds_[i].forms.add_to_equations(weights_, bounds_[i].multiplier, left, right);
  const Eigen::Vector3d best = weights::solve_symmetric(left, right);
  return best.allFinite() ? best : start_position_;
}

/// Reduces the number of positive weights to `maximum`, each time dropping the one that is missed
/// least. 0: no limit.
/// @param turns  turns of alternate() without each candidate before its loss is known. 0: the bind
///         position stays.
/// @return whether any weight was dropped.
bool PointRefit::Problem::drop_influences(std::size_t maximum, int turns) {
  const auto used = [&] {
    return static_cast<std::size_t>(
        std::count_if(weights_.begin(), weights_.end(), [](double w) { return w > 0; }));
  };
  if (maximum == 0 || used() <= maximum) return false;
  while (used() > maximum) {
    double least = 0;
    std::size_t dropped = terms_.size();
    scratch_.before = weights_;
    const Eigen::Vector3d from = position_;
    Eigen::Vector3d best = from;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (!(scratch_.before[i] > 0)) continue;
      for (std::size_t j = 0; j < terms_.size(); ++j)
        allowed_[j] = j != i && scratch_.before[j] > 0;
      weights_ = scratch_.before;
      weights_[i] = 0;
      // Summed instead of 1 - before[i], which would be 0 if that weight is almost one.
      const double rest = std::accumulate(weights_.begin(), weights_.end(), 0.0);
      for (double& weight : weights_) weight /= rest;
      position_ = from;
      if (turns > 0) set_position(position_);
      solver_.solve(weights_, allowed_);
      alternate(turns);
      const double value = solver_.value(weights_);
      if (dropped < terms_.size() && !(value < least)) continue;
      least = value;
      dropped = i;
      scratch_.best = weights_;
      best = position_;
    }
    weights_ = scratch_.best;
    position_ = best;
  }
  for (std::size_t i = 0; i < terms_.size(); ++i) allowed_[i] = weights_[i] > 0;
  return true;
}

/// At most `most` turns, from weights that are optimal for the current bind position. While turns
/// gain, each step of the bind position overshoots the optimum for the current weights farther;
/// plain alternation would creep along valleys.
void PointRefit::Problem::alternate(int most) {
  if (most == 0) return;
  double before = cost(), stride = 1;
  for (int turn = 0; turn < most; ++turn) {
    const Eigen::Vector3d from = position_;
    scratch_.earlier = weights_;
    position_ += stride * (best_position() - position_);
    set_position(position_);
    solver_.solve(weights_, allowed_);
    const double after = cost();
    const bool gains = after < (1 - kLeastGain) * before;
    if (!gains && stride == 1) return;
    if (!(after < before)) {
      position_ = from;
      weights_ = scratch_.earlier;
      set_position(position_);
    } else {
      before = after;
    }
    stride = gains ? kGrowth * stride : 1;
  }
}

/// Starts from the current weights and the position that was set last.
void PointRefit::Problem::improve(const Options& options) {
  allowed_.assign(terms_.size(), true);
  solver_.solve(weights_, allowed_);
  const int turns = options.moves_bind ? kMostTurns : 0;
  alternate(turns);
  if (drop_influences(options.maximum_influences, std::min(turns, kTurnsOfChoice)))
    alternate(turns);
}

/// From here on, weights and bind position change at no cost.
void PointRefit::Problem::remove_restraint() {
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    solver_.gram(i, i) -= restraint_.of_weights;
    solver_.linear(i) -= restraint_.of_weights * start_[i];
  }
  tie_ -= restraint_.of_weights;
  restraint_ = {};
}

/// Replaces the restrained fit, which was just made, by the most restrained one that costs next to
/// nothing.
void PointRefit::Problem::restrain_where_cheap(const Options& options) {
  const weights::Restraint whole = restraint_;
  const Eigen::Vector3d held_position = position_;
  scratch_.restrained = weights_;
  remove_restraint();
  const double held_back = cost();
  improve(options);
  const double most = kWorth * cost();
  const Eigen::Vector3d free_position = position_;
  scratch_.unrestrained = weights_;
  position_ = held_position;
  weights_ = scratch_.restrained;
  if (held_back <= most) return;
  for (const double part : {0.1, 0.01}) {
    if (!options.moves_bind) break;  // fitting weights alone has to be fast
    restraint_ = {part * whole.of_position, part * whole.of_weights};
    set_position(position_);
    improve(options);
    if (cost() <= most) return;
    position_ = held_position;
    weights_ = scratch_.restrained;
  }
  position_ = free_position;
  weights_ = scratch_.unrestrained;
}

/// The weights as they will be stored, and the value with them.
void PointRefit::Problem::store(const State& from, State& to) {
  weights::store_weights(terms_, from.weights, influences_);
  weights::weights_of_terms(terms_, influences_, to.weights);
  to.position = from.position;
  to.value = objective_.mean_square(to.weights, to.position);
}

/// Whether a bound is exceeded; excess_ has by how much.
bool PointRefit::Problem::find_excess(const PointToRefit& point, const State& state) {
  if (point.allowed.empty() && point.own_poses == nullptr) return false;
  weights::differences(terms_, state.weights, state.position, difference_);
  return weights::exceeds_bounds(point, *moments_, difference_, excess_);
}

/// Raises the multiplier of a bound; the first time the bound comes into use.
/// @param gain  by which the objective can fall at most.
void PointRefit::Problem::raise_multiplier(const PointToRefit& point, std::size_t group,
                                           double gain) {
  for (std::size_t i = 0; i < bound_count_; ++i)
    if (bounds_[i].group == group) {
      bounds_[i].multiplier *= kRaise;
      return;
    }
  const bool is_own = group == point.allowed.size();
  if (bound_count_ == bounds_.size()) bounds_.emplace_back();
  Bound& bound = bounds_[bound_count_++];
  if (is_own)
    bound.forms.begin(terms_, *point.own_poses, 0);
  else
    bound.forms.begin(terms_, *moments_, group);
  bound.group = group;
  bound.multiplier = gain / (is_own ? point.own_allowed : point.allowed[group]);
}

/// Raises the multipliers of all bounds that the last attempt exceeded.
void PointRefit::Problem::raise_multipliers(const PointToRefit& point, double gain) {
  for (std::size_t group = 0; group < excess_.size(); ++group)
    if (!(excess_[group] <= 1)) raise_multiplier(point, group, gain);
}

/// Looks for a fit over the allowed bones that exceeds no bound, starting from the current weights
/// and position.
/// @return whether there is one; it is in stored_ then.
bool PointRefit::Problem::search_multipliers(const PointToRefit& point, int turns, double gain) {
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    raise_multipliers(point, gain);
    set_position(position_);
    solver_.solve(weights_, allowed_);
    alternate(turns);
    between_.weights = weights_;
    between_.position = position_;
    store(between_, stored_);
    if (!find_excess(point, stored_)) return true;
  }
  return false;
}

/// The longest step from some weights towards those of the solver after which all bounds hold: 1
/// for the whole way. Over each group the mean square is quadratic in the step.
/// @param blocking  the group that a longer step would exceed.
double PointRefit::Problem::longest_step(const PointToRefit& point, const State& from,
                                         std::size_t& blocking) {
  weights::differences(terms_, from.weights, from.position, difference_);
  (void)weights::exceeds_bounds(point, *moments_, difference_, excess_before_);
  weights::differences(terms_, weights_, from.position, difference_);
  (void)weights::exceeds_bounds(point, *moments_, difference_, excess_);
  const Eigen::Vector3d& at = from.position;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const double change = weights_[i] - from.weights[i];
    difference_[i].q = {change * at.x(), change * at.y(), change * at.z(), change};
  }
  (void)weights::exceeds_bounds(point, *moments_, difference_, excess_of_step_);
  double longest = 1;
  for (std::size_t group = 0; group < excess_.size(); ++group) {
    if (excess_[group] <= 1) continue;
    // before + 2 slope t + curvature t^2 = 1
    const double curvature = excess_of_step_[group], before = std::min(excess_before_[group], 1.0);
    const double slope = 0.5 * (excess_[group] - excess_before_[group] - curvature);
    const double root = std::sqrt(slope * slope + curvature * (1 - before));
    const double step = slope > 0 ? (1 - before) / (slope + root) : (root - slope) / curvature;
    if (step < longest) {
      longest = std::max(step, 0.0);
      blocking = group;
    }
  }
  return longest;
}

/// Improves weights that exceed no bound, over the allowed bones: each step goes towards the
/// optimum with multipliers as far as all bounds hold, and raises the multiplier of the bound that
/// stops it.
void PointRefit::Problem::descend(const PointToRefit& point, State& from) {
  for (int attempt = 0; attempt < kMostDescents; ++attempt) {
    weights_ = from.weights;
    position_ = from.position;
    set_position(position_);
    solver_.solve(weights_, allowed_);
    std::size_t blocking = 0;
    const double step = kSafety * longest_step(point, from, blocking);
    between_.weights.resize(terms_.size());
    for (std::size_t k = 0; k < terms_.size(); ++k)
      between_.weights[k] = from.weights[k] + step * (weights_[k] - from.weights[k]);
    between_.position = from.position;
    store(between_, stored_);
    const double before = from.value;
    if (stored_.value < before && !find_excess(point, stored_)) std::swap(from, stored_);
    if (step >= kSafety || attempt + 1 == kMostDescents) return;
    const double gain = before - objective_.mean_square(weights_, from.position);
    raise_multiplier(point, blocking, std::max(gain, kLeastGain * before));
  }
}

/// Replaces `best`, the barycentric start, by the best fit found that exceeds no bound. The fit
/// without bounds is in beyond_, and excess_ says what it exceeds.
void PointRefit::Problem::keep_bounds(const PointToRefit& point, const Options& options,
                                      State& best) {
  restraint_ = {};
  const double gain = std::max(best.value - beyond_.value, kLeastGain * best.value);
  // First over the bones of the fit without bounds.
  for (std::size_t i = 0; i < terms_.size(); ++i) allowed_[i] = beyond_.weights[i] > 0;
  weights_ = beyond_.weights;
  position_ = beyond_.position;
  if (search_multipliers(point, options.moves_bind ? kTurnsOfChoice : 0, gain)) {
    std::swap(beyond_, stored_);
    for (std::size_t i = 0; i < bound_count_; ++i) bounds_[i].multiplier /= kRaise;
    descend(point, beyond_);
  } else {
    beyond_.value = best.value;
  }
  // Then over those of the start, which exceeds none.
  for (std::size_t i = 0; i < terms_.size(); ++i) allowed_[i] = start_[i] > 0;
  bound_count_ = 0;
  descend(point, best);
  if (beyond_.value < best.value) std::swap(best, beyond_);
}

PointRefit::Fit PointRefit::Problem::solve(const PointToRefit& point, Options options) {
  options.moves_bind = options.moves_bind && point.may_move;
  Fit result;
  result.position = point.position;
  result.influences = point.barycentric;
  set_position(position_);
  result.barycentric_mean_square = result.mean_square = cost();
  if (terms_.size() < 2) return result;
  improve(options);
  restrain_where_cheap(options);
  between_.weights = weights_;
  between_.position = position_;
  store(between_, best_);  // only the stored weights count
  if (find_excess(point, best_)) {
    std::swap(beyond_, best_);
    best_.weights = start_;
    best_.position = start_position_;
    best_.value = result.barycentric_mean_square;
    keep_bounds(point, options, best_);
  }
  if (!(best_.value < result.barycentric_mean_square)) return result;
  weights::store_weights(terms_, best_.weights, influences_);
  result.mean_square = best_.value;
  result.influences = influences_;
  if (best_.position != start_position_)
    result.position = Eigen::Vector3d(best_.position + Eigen::Vector3d(moments_->centre()));
  result.is_better = true;
  return result;
}

}  // namespace sunder
