#include "tear/weights/refit_skin.h"

#include <sunder/skinning/deform.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/weights/refit_certificate.h"
#include "weights/internal/coupled_refit.h"
#include "weights/internal/refit_terms.h"

namespace sunder::tear {
namespace {

/// A fit that reduces the mean square by less than this fraction is not worth a change.
constexpr double kLeastGain = 2e-3;

/// Rounding of a mean square that is a sum of moments, relative to the squared distances in it.
constexpr double kMomentRounding = 16 * std::numeric_limits<double>::epsilon();

/// Mean squares below this multiple of that of rounding do not count.
constexpr double kWorthwhile = 100;

Vec3d mean_position(const RefitTask& task, std::span<const std::size_t> points) {
  Vec3d sum = Vec3d::Zero();
  for (const std::size_t i : points) sum += task.points[i].position;
  return sum / static_cast<double>(points.size());
}

/// The mean of the squared scales of the bones that move a point, over a group of poses.
double squared_scale(const AnimationPoint& point, const PoseMoments& moments, std::size_t group) {
  if (moments.pose_count(group) == 0) return 0;
  double sum = 0, weights = 0;
  for (const AnimationPoint::Term& term : point.terms()) {
    const double weight = std::abs(term.q.w());
    sum += weight * trace(moments.of(term.slot, term.slot, group).topLeftCorner<3, 3>()) / 3;
    weights += weight;
  }
  const auto poses = static_cast<double>(moments.pose_count(group));
  return weights > 0 ? sum / (weights * poses) : 0.0;
}

}  // namespace

SkinRefit::SkinRefit(const RefitTask& task, Index skin, std::vector<std::size_t> points,
                     RefitCertificate& certificate)
    : task_(task),
      skin_(skin),
      points_(std::move(points)),
      certificate_(certificate),
      fits_(points_.size()),
      moments_(0, Vec3d::Zero()),
      bounds_(0, {}),
      rounding_(points_.size()) {}

Status SkinRefit::run() {
  if (Status status = add_poses(); !status) return status;
  if (Status status = add_own_poses(); !status) return status;
  if (task_.is_cancelled) return {};
  set_bounds();
  set_objective();
  if (task_.operation.refit.is_coupled) return fit_together();
  fit_alone();
  return {};
}

/// Adds the poses of all groups to the moments.
Status SkinRefit::add_poses() {
  const Skin& skin = task_.source->skins[skin_];
  std::vector<bool> moves_points(task_.source->skeleton.bones.size(), false);
  for (const std::size_t i : points_)
    for (const AnimationPoint::Term& term : task_.points[i].exact.terms())
      moves_points[skin.bones[term.slot]] = true;
  auto poses = RefitPoses::create(task_.source, task_.operation.refit, moves_points);
  if (!poses) return poses.error();
  poses_ = std::move(*poses);
  const auto& groups = poses_->groups();
  moments_ = PoseMoments(skin.bones.size(), mean_position(task_, points_), groups.size() + 1);
  for (const std::size_t i : points_) moments_.want(task_.points[i].exact);
  std::vector<Affine3d> palette(skin.bones.size());
  ModelPose pose;
  for (std::size_t group = 0; group < groups.size(); ++group)
    for (const std::size_t number : groups[group].poses) {
      if (task_.is_cancelled) return {};
      if (Status status = poses_->compute(number, pose); !status) return status;
      if (Status status = compute_palette(skin, pose, palette); !status) return status;
      moments_.add(palette, group, poses_->weight_of(number));
    }
  return {};
}

/// Makes the moments of the poses in which the operations were made.
Status SkinRefit::add_own_poses() {
  const Skin& skin = task_.source->skins[skin_];
  for (const std::size_t i : points_)
    own_.try_emplace(task_.points[i].operation, skin.bones.size(), moments_.centre())
        .first->second.want(task_.points[i].exact);
  std::vector<Affine3d> palette(skin.bones.size());
  for (auto& [operation, moments] : own_)
    for (const ModelPose& pose : task_.operations[operation].poses) {
      if (Status status = compute_palette(skin, pose, palette); !status) return status;
      moments.add(palette);
    }
  return {};
}

/// Measures the barycentric weights, which sets the bounds of all points.
void SkinRefit::set_bounds() {
  const std::size_t groups = poses_->groups().size();
  std::vector<Index> operations;
  for (const std::size_t i : points_) operations.push_back(task_.points[i].operation);
  bounds_ = RefitBounds(groups + 1, operations);
  std::vector<double> squares(groups + 1);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const RefitTask::Point& point = task_.points[points_[i]];
    measure(i, task_.barycentric(points_[i]), point.position, squares);
    double reach = 0;  // matrices are stored in float too
    for (const AnimationPoint::Term& term : point.exact.terms())
      reach = std::max(
          reach,
          norm(task_.source->skins[skin_].bone_from_bind[term.slot].translation().cast<double>()));
    const double stored = kStoredFitLengths * (norm(point.position) + reach);
    const PoseMoments& own = own_.at(point.operation);
    for (std::size_t group = 0; group <= groups; ++group) {
      const double scale_square = group < groups ? squared_scale(point.exact, moments_, group)
                                                 : squared_scale(point.exact, own, 0);
      const double rounding = stored * stored * scale_square + 1e-280;
      rounding_[i] = std::max(rounding_[i], rounding);
      bounds_.set_barycentric(i, group, squares[group], rounding);
    }
  }
  bounds_.begin();
}

/// Sets the sum to minimise.
void SkinRefit::set_objective() {
  const std::size_t groups = poses_->groups().size();
  std::vector<double> factors(groups + 1, 0.0);
  for (std::size_t group = 0; group < groups; ++group) {
    double sum = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double bound = bounds_.barycentric(i)[group];
      if (bound > kWorthwhile * rounding_[i]) sum += bound;
    }
    if (sum > 0) factors[group] = poses_->groups()[group].importance / sum;
    square_ += factors[group];
  }
  moments_.combine(factors, groups);
}

/// Computes the mean squared errors of a point with some weights: over each group of poses, and
/// last over those of its operation.
void SkinRefit::measure(std::size_t i, std::span<const Influence> influences, const Vec3d& position,
                        std::span<double> squares) {
  const RefitTask::Point& point = task_.points[points_[i]];
  weights::centre_terms(point.exact, moments_, scratch_.terms);
  weights::weights_of_terms(scratch_.terms, influences, scratch_.of_terms);
  weights::differences(scratch_.terms, scratch_.of_terms, position - moments_.centre(),
                       scratch_.difference);
  moments_.mean_squares(scratch_.difference, squares.first(squares.size() - 1));
  squares.back() = own_.at(point.operation).mean_square(scratch_.difference);
}

PointRefit::Options SkinRefit::options() const {
  return {task_.operation.weights.maximum_influences, task_.operation.refit.moves_bind,
          poses_->groups().size()};
}

PointToRefit SkinRefit::to_refit(std::size_t i) const {
  const RefitTask::Point& point = task_.points[points_[i]];
  PointToRefit result;
  result.exact = &point.exact;
  result.position = point.position;
  result.barycentric = task_.barycentric(points_[i]);
  const std::span<const double> allowed = bounds_.allowed(i);
  result.allowed = allowed.first(allowed.size() - 1);
  result.own_poses = &own_.at(point.operation);
  result.own_allowed = allowed.back();
  result.may_move = !bounds_.is_exact(i);
  return result;
}

/// Whether a fit is worth more than it may lose when it is stored.
bool SkinRefit::gains(std::size_t i, double mean_square, double barycentric) const {
  const double share = barycentric > 0 ? mean_square / barycentric : 1.0;
  double most = 0;
  for (std::size_t group = 0; group < poses_->groups().size(); ++group)
    if (poses_->groups()[group].importance > 0)
      most = std::max(most, bounds_.barycentric(i)[group]);
  return share < 1 - kLeastGain &&
         std::sqrt(most) * (1 - std::sqrt(share)) > std::sqrt(rounding_[i]);
}

void SkinRefit::fit_alone() {
  PointRefit refit;
  std::vector<std::size_t> open(points_.size());
  std::iota(open.begin(), open.end(), 0u);
  for (; !open.empty() && !task_.is_cancelled; open = tighten()) {
    for (std::size_t n = 0; n < open.size() && !task_.is_cancelled; ++n) fit(open[n], refit);
    keep_certified(open);
  }
}

void SkinRefit::fit(std::size_t i, PointRefit& refit) {
  if (bounds_.is_kept(i)) return reject(i);
  PointToRefit point = to_refit(i);
  PointRefit::Fit fit = refit.fit(point, options(), moments_);
  if (norm(fit.position - point.position) > task_.points[points_[i]].reach) {
    point.may_move = false;
    fit = refit.fit(point, options(), moments_);
  }
  take(i, {points_[i],
           fit.is_better && gains(i, fit.mean_square, fit.barycentric_mean_square),
           {fit.influences.begin(), fit.influences.end()},
           fit.position});
}

/// Takes a fit as it is stored, if it exceeds no bound over any group.
void SkinRefit::take(std::size_t i, PointFit fit) {
  if (!fit.is_taken || bounds_.is_kept(i)) return reject(i);
  const RefitTask::Point& point = task_.points[points_[i]];
  if (fit.position != point.position) fit.position = point.stored(fit.position);
  const std::span<double> squares = bounds_.of_fit(i);
  measure(i, fit.influences, fit.position, squares);
  if (!std::ranges::equal(squares, bounds_.allowed(i), std::less_equal<>())) return reject(i);
  set_doubt(i, fit.influences);
  fits_[i] = std::move(fit);
}

/// Sets by how much the change of the mean squares of a point can differ from the measured one:
/// sums of stored weights miss one, which moves a posed point by that share of its distance from
/// the origin, and moments are sums of squared distances in double.
void SkinRefit::set_doubt(std::size_t i, std::span<const Influence> influences) {
  const auto missing = [](std::span<const Influence> of) {
    double sum = 0;
    for (const Influence& influence : of) sum += static_cast<double>(influence.weight);
    return std::abs(sum - 1);
  };
  double exact = 0;
  for (const AnimationPoint::Term& term : task_.points[points_[i]].exact.terms())
    exact += term.q.w();
  const double missed =
      missing(influences) + missing(task_.barycentric(points_[i])) + 2 * std::abs(exact - 1);
  const std::span<double> doubt = bounds_.doubt(i);
  for (std::size_t group = 0; group < doubt.size(); ++group) {
    const double length = std::sqrt(bounds_.rounding(i)[group]) / kStoredFitLengths;
    const double moved = missed * length;
    const double error =
        std::sqrt(std::max(bounds_.of_fit(i)[group], bounds_.barycentric(i)[group]));
    doubt[group] = (2 * error + moved) * moved + kMomentRounding * length * length;
  }
}

std::vector<std::size_t> SkinRefit::tighten() {
  return bounds_.tighten([this](std::span<const std::size_t> points, std::size_t group) {
    return posed_changes(points, group);
  });
}

/// The changes of mean squares over a group, from each of its poses and the weights as they are
/// stored.
std::vector<double> SkinRefit::posed_changes(std::span<const std::size_t> points,
                                             std::size_t group) {
  std::vector<double> changes(points.size(), 0.0);
  if (group == poses_->groups().size()) {  // all points are of one operation
    const auto& own = task_.operations[task_.points[points_[points.front()]].operation].poses;
    for (const ModelPose& pose : own)
      add_posed_changes(points, pose, 1.0 / static_cast<double>(own.size()), changes);
    return changes;
  }
  const auto& numbers = poses_->groups()[group].poses;
  ModelPose pose;
  for (const std::size_t number : numbers)
    if (poses_->compute(number, pose))
      add_posed_changes(points, pose,
                        poses_->weight_of(number) / static_cast<double>(numbers.size()), changes);
  return changes;
}

void SkinRefit::add_posed_changes(std::span<const std::size_t> points, const ModelPose& pose,
                                  double share, std::vector<double>& changes) {
  const Skin& skin = task_.source->skins[skin_];
  scratch_.palette.resize(skin.bones.size());
  if (!compute_palette(skin, pose, scratch_.palette)) return;
  const auto posed = [&](std::span<const Influence> influences, const Vec3d& position) {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (const Influence& influence : influences)
      at += static_cast<double>(influence.weight) *
            (scratch_.palette[influence.slot] * Eigen::Vector3d(position));
    return at;
  };
  for (std::size_t n = 0; n < points.size(); ++n) {
    const PointFit& fit = fits_[points[n]];
    if (!fit.is_taken) continue;
    const RefitTask::Point& point = task_.points[points_[points[n]]];
    const Eigen::Vector3d exact = point.exact.posed(scratch_.palette);
    changes[n] +=
        share *
        ((posed(fit.influences, fit.position) - exact).squaredNorm() -
         (posed(task_.barycentric(points_[points[n]]), point.position) - exact).squaredNorm());
  }
}

/// Lets a point have barycentric weights.
void SkinRefit::reject(std::size_t i) {
  fits_[i] = PointFit();
  fits_[i].point = points_[i];
  fits_[i].certified = task_.points[points_[i]].certified;
  std::ranges::copy(bounds_.barycentric(i), bounds_.of_fit(i).begin());
  std::ranges::fill(bounds_.doubt(i), 0.0);
}

/// Gives up the fits, of some points, that could stray farther in some pose than the options allow.
void SkinRefit::keep_certified(std::span<const std::size_t> fitted) {
  std::vector<std::size_t> taken;
  for (const std::size_t i : fitted)
    if (fits_[i].is_taken) taken.push_back(i);
  for (const std::size_t i : taken)
    certificate_.add(task_.points[points_[i]].exact, fits_[i].influences, fits_[i].position,
                     static_cast<std::uint32_t>(skin_));
  const std::vector<double> bounds = certificate_.take_bounds();
  const double most = task_.operation.refit.bound * task_.report.certified_barycentric;
  for (std::size_t n = 0; n < taken.size(); ++n) {
    const std::size_t i = taken[n];
    fits_[i].certified = bounds[n];
    if (task_.operation.refit.bound == 0 || bounds[n] <= most ||
        !std::isfinite(task_.points[points_[i]].certified))
      continue;
    bounds_.keep(i);
    reject(i);
  }
}

/// Fits all points in one problem.
Status SkinRefit::fit_together() {
  std::vector<Index> number(task_.points.size(), kNone);
  for (std::size_t i = 0; i < points_.size(); ++i) number[points_[i]] = static_cast<Index>(i);
  std::vector<RefitNeighbours> of_these;
  for (const RefitNeighbours& pair : task_.neighbours) {
    const Index a = number[pair.a], b = pair.b == kNone ? kNone : number[pair.b];
    if (a != kNone && (b != kNone || pair.b == kNone)) of_these.push_back({a, b, pair.length});
  }
  const double smoothness = task_.operation.refit.smoothness * square_;
  std::vector<PointToRefit> together(points_.size());
  std::vector<bool> stays(points_.size(), false);
  std::vector<std::size_t> all(points_.size());
  std::iota(all.begin(), all.end(), 0u);
  bool is_done = false;
  while (!is_done && !task_.is_cancelled) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      together[i] = to_refit(i);
      together[i].may_move = together[i].may_move && !stays[i] && !bounds_.is_kept(i);
    }
    const auto fits = refit_coupled(together, of_these, {options(), smoothness}, moments_);
    if (!fits) return fits.error();
    is_done = true;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const CoupledFit& fit = (*fits)[i];
      if (norm(fit.position - together[i].position) > task_.points[points_[i]].reach) {
        stays[i] = true;
        is_done = false;
      }
      take(i, {points_[i], fit.is_better && gains(i, fit.mean_square, fit.barycentric_mean_square),
               fit.influences, fit.position});
    }
    keep_certified(all);
    is_done = is_done && tighten().empty();
  }
  return {};
}

}  // namespace sunder::tear
