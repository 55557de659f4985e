#include "tear/weights/refit_skin.h"

#include <sunder/skinning/deform.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "weights/internal/coupled_refit.h"

namespace sunder::tear {
namespace {

/// A fit that reduces the mean square by less than this fraction is not worth a change.
constexpr double kLeastGain = 2e-3;

/// Mean squares below this multiple of that of rounding do not count.
constexpr double kWorthwhile = 100;

/// What the bounds over random poses are exceeded by in one attempt after the other, as multiples
/// of the mean of all points, until all points together have this much of the mean square of
/// barycentric weights there.
constexpr double kSlacks[] = {1e6, 8.0, 1.0, 0.0};
constexpr double kSureGain = 0.97;

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

/// The difference between a point with some weights and its exact motion, about the centre of the
/// moments.
std::vector<AnimationPoint::Term> difference_of(const AnimationPoint& exact,
                                                std::span<const Influence> influences,
                                                const Vec3d& position, const Vec3d& centre) {
  double sum = 0, exact_sum = 0;
  for (const Influence& influence : influences) sum += static_cast<double>(influence.weight);
  for (const AnimationPoint::Term& term : exact.terms()) exact_sum += term.q.w();
  std::vector<AnimationPoint::Term> terms;
  for (const AnimationPoint::Term& term : exact.terms()) {
    double weight = 0;
    for (const Influence& influence : influences)
      if (influence.slot == term.slot) weight = static_cast<double>(influence.weight) / sum;
    Vec4d q = -term.q / exact_sum;
    q.head<3>() -= q.w() * centre;
    q.head<3>() += weight * (position - centre);
    q.w() += weight;
    terms.push_back({term.slot, q});
  }
  return terms;
}

}  // namespace

SkinRefit::SkinRefit(const RefitTask& task, Index skin, std::vector<std::size_t> points)
    : task_(task),
      skin_(skin),
      points_(std::move(points)),
      moments_(0, Vec3d::Zero()),
      bounds_(points_.size()) {}

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
  random_ = static_cast<std::size_t>(
      std::find_if(poses_->groups().begin(), poses_->groups().end(),
                   [](const RefitPoses::Group& group) { return group.is_random; }) -
      poses_->groups().begin());
  allowed_.assign(points_.size() * groups, 0.0);
  for (std::size_t i = 0; i < points_.size(); ++i) set_bounds_of(i, to_refit(i));
}

/// Sets the sum to minimise.
void SkinRefit::set_objective() {
  const std::size_t groups = poses_->groups().size();
  std::vector<double> factors(groups + 1, 0.0);
  for (std::size_t group = 0; group < groups; ++group) {
    double sum = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double bound = allowed_[i * groups + group];
      if (bound > kWorthwhile * bounds_[i].rounding) sum += bound;
    }
    if (sum > 0) factors[group] = poses_->groups()[group].importance / sum;
  }
  moments_.combine(factors, groups);
}

void SkinRefit::set_bounds_of(std::size_t i, const PointToRefit& point) {
  const std::size_t groups = poses_->groups().size();
  const auto difference =
      difference_of(*point.exact, point.barycentric, point.position, moments_.centre());
  const std::span<double> allowed = std::span(allowed_).subspan(i * groups, groups);
  moments_.mean_squares(difference, allowed);
  Bounds& bounds = bounds_[i];
  double reach = 0;  // matrices are stored in float too
  for (const AnimationPoint::Term& term : point.exact->terms())
    reach = std::max(
        reach,
        norm(task_.source->skins[skin_].bone_from_bind[term.slot].translation().cast<double>()));
  const double stored = kStoredFitLengths * (norm(point.position) + reach);
  const auto at_least_rounding = [&](double& bound, double scale_square) {
    const double rounding = stored * stored * scale_square + 1e-280;
    bounds.rounding = std::max(bounds.rounding, rounding);
    bounds.is_exact = bounds.is_exact || bound <= rounding;
    bound = std::max(bound, rounding);
  };
  for (std::size_t group = 0; group < groups; ++group) {
    at_least_rounding(allowed[group], squared_scale(*point.exact, moments_, group));
    if (poses_->groups()[group].importance > 0) bounds.most = std::max(bounds.most, allowed[group]);
  }
  if (random_ < groups) bounds.random = allowed[random_];
  const PoseMoments& own = own_.at(task_.points[points_[i]].operation);
  bounds.own = own.mean_square(difference);
  at_least_rounding(bounds.own, squared_scale(*point.exact, own, 0));
}

PointRefit::Options SkinRefit::options() const {
  return {task_.operation.weights.maximum_influences, task_.operation.refit.moves_bind,
          poses_->groups().size()};
}

PointToRefit SkinRefit::to_refit(std::size_t i) const {
  const RefitTask::Point& point = task_.points[points_[i]];
  const std::size_t groups = poses_->groups().size();
  PointToRefit result;
  result.exact = &point.exact;
  result.position = point.position;
  result.barycentric = task_.barycentric(points_[i]);
  result.allowed = std::span(allowed_).subspan(i * groups, groups);
  result.own_poses = &own_.at(point.operation);
  result.own_allowed = bounds_[i].own;
  result.may_move = !bounds_[i].is_exact;
  return result;
}

/// Whether a fit is worth more than it may lose when it is stored.
bool SkinRefit::gains(std::size_t i, double mean_square, double barycentric) const {
  const double share = barycentric > 0 ? mean_square / barycentric : 1.0;
  return share < 1 - kLeastGain &&
         std::sqrt(bounds_[i].most) * (1 - std::sqrt(share)) > std::sqrt(bounds_[i].rounding);
}

/// Whether all points together gain, or none is worse, over the random poses.
bool SkinRefit::keeps_random_poses() const {
  if (random_ == poses_->groups().size()) return true;
  double before = 0, after = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    before += bounds_[i].random;
    if (!fits_[i].is_taken) {
      after += bounds_[i].random;
      continue;
    }
    const auto difference = difference_of(task_.points[points_[i]].exact, fits_[i].influences,
                                          fits_[i].position, moments_.centre());
    after += moments_.mean_square(difference, random_);
  }
  return after <= kSureGain * before;
}

void SkinRefit::fit_alone() {
  const std::size_t groups = poses_->groups().size();
  double sum = 0;
  for (const Bounds& bounds : bounds_) sum += bounds.random;
  for (const double slack : kSlacks) {
    for (std::size_t i = 0; i < points_.size() && random_ < groups; ++i)
      allowed_[i * groups + random_] =
          bounds_[i].random + slack * sum / static_cast<double>(points_.size());
    fit_each();
    if (task_.is_cancelled || keeps_random_poses()) return;
  }
}

void SkinRefit::fit_each() {
  PointRefit refit;
  fits_.clear();
  for (std::size_t i = 0; i < points_.size() && !task_.is_cancelled; ++i) {
    PointToRefit point = to_refit(i);
    PointRefit::Fit fit = refit.fit(point, options(), moments_);
    if (norm(fit.position - point.position) > task_.points[points_[i]].reach) {
      point.may_move = false;
      fit = refit.fit(point, options(), moments_);
    }
    fits_.push_back({points_[i],
                     fit.is_better && gains(i, fit.mean_square, fit.barycentric_mean_square),
                     {fit.influences.begin(), fit.influences.end()},
                     fit.position});
  }
}

/// Fits all points in one problem.
Status SkinRefit::fit_together() {
  std::vector<PointToRefit> together;
  std::vector<Index> number(task_.points.size(), kNone);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    number[points_[i]] = static_cast<Index>(i);
    together.push_back(to_refit(i));
  }
  std::vector<RefitNeighbours> of_these;
  for (const RefitNeighbours& pair : task_.neighbours) {
    const Index a = number[pair.a], b = pair.b == kNone ? kNone : number[pair.b];
    if (a != kNone && (b != kNone || pair.b == kNone)) of_these.push_back({a, b, pair.length});
  }
  const auto fits =
      refit_coupled(together, of_these, {options(), task_.operation.refit.smoothness}, moments_);
  if (!fits) return fits.error();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const CoupledFit& fit = (*fits)[i];
    const bool stays = norm(fit.position - together[i].position) > task_.points[points_[i]].reach;
    fits_.push_back(
        {points_[i],
         fit.is_better && !stays && gains(i, fit.mean_square, fit.barycentric_mean_square),
         fit.influences, fit.position});
  }
  return {};
}

}  // namespace sunder::tear
