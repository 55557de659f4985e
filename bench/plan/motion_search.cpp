#include "bench/plan/motion_search.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace sunder::bench {
namespace {

constexpr double kDepthShare = 0.45;         ///< Of the wanted depth; plans allow 0.5.
constexpr double kDepthShareBetween = 0.02;  ///< Of places between those that are walked.
constexpr double kEnough = 0.5;              ///< Of the tolerance.
constexpr double kOfSpeed = 0.9;
constexpr int kEvery = 4;     ///< Samples from one that is walked to the next.
constexpr int kStarts = 240;  ///< Random ones.
constexpr int kMostJudged = 12;
constexpr int kMostWalks = 40;      ///< From starts that are free.
constexpr std::size_t kWidth = 12;  ///< Of a layer.
constexpr int kTrials = 5;          ///< For each of its values.
constexpr double kTurn = 3.2;       ///< Radians or metres, of values without limits.
constexpr double kPull = 0.1;       ///< Tolerances that a radian off the wanted direction counts.
constexpr double kStep = 1e-6;      ///< Of differences.

}  // namespace

MotionSearch::MotionSearch(const PlanCase& of, double tolerance, LinkDepth& links)
    : of_(of),
      tolerance_(tolerance),
      links_(links),
      gaps_(of.tool),
      kinematics_(*RobotKinematics::create(of.tool.robot)),
      frames_(of.tool.robot.links.size()),
      random_(11) {
  for (const RobotValue& value : of.tool.robot.values) {
    limits_.lower.push_back(value.lower);
    limits_.upper.push_back(value.upper);
    const double speed = of.tool.robot.joints[value.joint].velocity;
    speeds_.push_back(speed > 0 ? kOfSpeed * speed : 1e9);
  }
  find_moved();
}

void MotionSearch::find_moved() {
  const auto ends_of = [&](const Numbers& values) {
    Eigen::Matrix<double, 6, 1> ends = Eigen::Matrix<double, 6, 1>::Zero();
    if (!kinematics_.evaluate(values, frames_, of_.tool.world_from_root)) return ends;
    ends.head<3>() = frames_[of_.tool.blade.link] * of_.tool.blade.base;
    ends.tail<3>() = frames_[of_.tool.blade.link] * of_.tool.blade.tip;
    return ends;
  };
  for (std::size_t i = 0; i < speeds_.size(); ++i) {
    Numbers values = of_.middle_values;
    const auto before = ends_of(values);
    values[i] += 0.1;
    if ((ends_of(values) - before).norm() > 1e-12) moved_.push_back(i);
  }
}

MotionSearch::Numbers MotionSearch::random_values() {
  Numbers values = rest_values(of_.tool.robot);
  for (const std::size_t i : moved_)
    values[i] =
        random_.uniform(std::max(limits_.lower[i], -kTurn), std::min(limits_.upper[i], kTurn));
  return values;
}

MotionSearch::Errors MotionSearch::errors_at(const plan::TargetSample& sample,
                                             const Numbers& values, double depth_share) {
  Errors errors = Errors::Constant(1e9);
  if (!kinematics_.evaluate(values, frames_, of_.tool.world_from_root)) return errors;
  const Vec3d base = frames_[of_.tool.blade.link] * of_.tool.blade.base;
  const Vec3d tip = frames_[of_.tool.blade.link] * of_.tool.blade.tip;
  const Vec3d along = (base - tip).normalized(), from = sample.place - tip;
  errors.head<3>() = (from - from.dot(along) * along) / tolerance_;
  const double allowed = depth_share * sample.full_depth;
  const double depth = from.dot(sample.normal);
  const double wanted = depth_share > 0.1
                            ? std::clamp(depth, sample.depth - allowed, sample.full_depth + allowed)
                            : std::clamp(depth, sample.depth - allowed, sample.depth + allowed);
  errors[3] = (depth - wanted) / tolerance_;
  errors.tail<3>() = kPull * (along - sample.handle);
  return errors;
}

bool MotionSearch::reach(const plan::TargetSample& sample, const Bounds& bounds, const Aim& aim,
                         Numbers& values) {
  const auto count = static_cast<Eigen::Index>(moved_.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = std::clamp(values[i], bounds.lower[i], bounds.upper[i]);
  for (int round = 0; round < 25; ++round) {
    Errors errors = errors_at(sample, values, aim.depth_share);
    if (!aim.is_pulled) errors.tail<3>().setZero();
    const Vec3d base = frames_[of_.tool.blade.link] * of_.tool.blade.base;
    if (errors.head<4>().norm() < aim.enough && (!aim.is_pulled || round > 8))
      return (base - sample.place).dot(sample.normal) > 0;
    Eigen::MatrixXd rates(7, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      Numbers changed = values;
      changed[moved_[static_cast<std::size_t>(k)]] += kStep;
      Errors moved = errors_at(sample, changed, aim.depth_share);
      if (!aim.is_pulled) moved.tail<3>().setZero();
      rates.col(k) = (moved - errors) / kStep;
    }
    // The least step; values at bounds that it would leave stay.
    Eigen::VectorXd step = Eigen::VectorXd::Zero(count);
    for (int pass = 0; pass < 3; ++pass) {
      Eigen::Matrix<double, 7, 7> square = rates * rates.transpose();
      square.diagonal().array() += 1e-9 * square.trace() + 1e-12;
      step = -rates.transpose() * square.inverse() * errors;
      bool is_held = false;
      for (Eigen::Index k = 0; k < count; ++k) {
        const std::size_t i = moved_[static_cast<std::size_t>(k)];
        const bool leaves = (step[k] > 0 && values[i] >= bounds.upper[i]) ||
                            (step[k] < 0 && values[i] <= bounds.lower[i]);
        if (!leaves) continue;
        rates.col(k).setZero();
        is_held = true;
      }
      if (!is_held) break;
    }
    for (Eigen::Index k = 0; k < count; ++k) {
      const std::size_t i = moved_[static_cast<std::size_t>(k)];
      values[i] =
          std::clamp(values[i] + std::clamp(step[k], -0.5, 0.5), bounds.lower[i], bounds.upper[i]);
    }
  }
  return false;
}

std::optional<double> MotionSearch::room_at(const plan::TargetSample& sample,
                                            const Numbers& values) {
  if (!kinematics_.evaluate(values, frames_, of_.tool.world_from_root)) return {};
  const double wanted = 0.03 * of_.rig.size;
  const double gap = gaps_.least(frames_, wanted);
  if (gap <= 0) return {};
  const Vec3d base = frames_[of_.tool.blade.link] * of_.tool.blade.base;
  const Vec3d tip = frames_[of_.tool.blade.link] * of_.tool.blade.tip;
  if (!links_.is_blade_outside(sample.time, base, sample.depth > 0 ? sample.place : tip)) return {};
  const double distance = std::min(gap, links_.least_distance(sample.time, frames_, wanted));
  if (distance <= 0) return {};
  double to_limits = 1;
  for (const std::size_t i : moved_) {
    const double least = std::min(values[i] - limits_.lower[i], limits_.upper[i] - values[i]);
    to_limits = std::min(to_limits, least / 0.2);
  }
  return distance / wanted + to_limits;
}

void MotionSearch::add_next(const std::vector<plan::TargetSample>& samples, std::size_t i,
                            const std::vector<Free>& layer, std::vector<Free>& next) {
  const double seconds = std::abs(samples[i].time - samples[i - 1].time);
  for (std::size_t of = 0; of < layer.size(); ++of) {
    Bounds bounds = limits_;
    const Numbers& from = layer[of].values;
    for (std::size_t k = 0; k < from.size(); ++k) {
      bounds.lower[k] = std::max(bounds.lower[k], from[k] - seconds * speeds_[k]);
      bounds.upper[k] = std::min(bounds.upper[k], from[k] + seconds * speeds_[k]);
    }
    for (int trial = 0; trial < kTrials; ++trial) {
      Free moved{from, 0, 0, static_cast<int>(of)};
      for (const std::size_t k : moved_)
        if (trial > 1) {
          const double most = 0.5 * std::min(seconds * speeds_[k], 0.3);
          moved.values[k] += random_.uniform(-most, most);
        }
      const bool is_reached =
          reach(samples[i], bounds, {kDepthShare, kEnough, trial == 1}, moved.values);
      if (!is_reached && samples[i].depth > 0) continue;
      const std::optional<double> room = room_at(samples[i], moved.values);
      if (!room) continue;
      moved.room = *room;
      moved.cost = layer[of].cost + cost_of(samples[i], from, moved.values, seconds);
      next.push_back(std::move(moved));
    }
  }
}

double MotionSearch::cost_of(const plan::TargetSample& sample, const Numbers& from,
                             const Numbers& to, double seconds) {
  double cost = 0;
  for (const std::size_t i : moved_) {
    const double share = (to[i] - from[i]) / std::min(seconds * speeds_[i], 0.3);
    cost += share * share;
  }
  return cost + errors_at(sample, to, 0).tail<3>().squaredNorm() / (kPull * kPull);
}

std::vector<MotionSearch::Numbers> MotionSearch::walk(
    const std::vector<plan::TargetSample>& samples, const Numbers& from) {
  std::vector<std::vector<Free>> layers = {{Free{from, 0, 0, -1}}};
  for (std::size_t i = 1; i < samples.size(); ++i) {
    std::vector<Free> next;
    add_next(samples, i, layers.back(), next);
    if (next.empty()) return {};
    // Some have the most room, some are the smoothest, the others are any.
    const auto partly_sort = [&](std::size_t first, const auto& is_better) {
      if (first < next.size())
        std::stable_sort(next.begin() + static_cast<std::ptrdiff_t>(first), next.end(), is_better);
    };
    partly_sort(0, [](const Free& a, const Free& b) { return a.room > b.room; });
    partly_sort(kWidth / 3, [](const Free& a, const Free& b) { return a.cost < b.cost; });
    for (std::size_t k = 2 * kWidth / 3; k + 1 < next.size() && k < kWidth; ++k)
      std::swap(next[k], next[k + random_.index(static_cast<std::uint32_t>(next.size() - k))]);
    if (next.size() > kWidth) next.resize(kWidth);
    layers.push_back(std::move(next));
  }
  std::vector<Numbers> track(samples.size());
  const auto smoothest =
      std::min_element(layers.back().begin(), layers.back().end(),
                       [](const Free& a, const Free& b) { return a.cost < b.cost; });
  auto of = static_cast<int>(smoothest - layers.back().begin());
  for (std::size_t i = samples.size(); i-- > 0; of = layers[i][static_cast<std::size_t>(of)].before)
    track[i] = layers[i][static_cast<std::size_t>(of)].values;
  return track;
}

RobotTrajectory MotionSearch::motion_through(const std::vector<plan::TargetSample>& samples,
                                             const std::vector<Numbers>& values,
                                             double depth_share) {
  RobotTrajectory motion;
  for (const RobotValue& value : of_.tool.robot.values) motion.names.push_back(value.name);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t before = i / kEvery, next = std::min(before + 1, values.size() - 1);
    const double share = static_cast<double>(i % kEvery) / kEvery;
    Numbers at = values[before];
    for (std::size_t k = 0; k < at.size(); ++k) at[k] += share * (values[next][k] - at[k]);
    if (samples[i].depth > 0) reach(samples[i], limits_, {depth_share, 0.05, false}, at);
    motion.times.push_back(samples[i].time);
    motion.values.insert(motion.values.end(), at.begin(), at.end());
  }
  return motion;
}

bool MotionSearch::is_free(const std::vector<plan::TargetSample>& samples,
                           const RobotTrajectory& motion) {
  const std::size_t count = speeds_.size();
  const auto values_at = [&](std::size_t i) {
    const auto first = motion.values.begin() + static_cast<std::ptrdiff_t>(i * count);
    return Numbers(first, first + static_cast<std::ptrdiff_t>(count));
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Numbers values = values_at(i);
    if (!room_at(samples[i], values)) return false;
    if (i < kEvery) continue;
    const Numbers before = values_at(i - kEvery);
    const double seconds = samples[i].time - samples[i - kEvery].time;
    for (std::size_t k = 0; k < count; ++k)
      if (std::abs(values[k] - before[k]) > seconds * speeds_[k] / kOfSpeed) return false;
  }
  return true;
}

bool MotionSearch::find(const std::vector<plan::TargetSample>& samples,
                        const std::function<bool(const RobotTrajectory&)>& is_good) {
  std::vector<plan::TargetSample> walked;
  for (std::size_t i = 0; i < samples.size(); i += kEvery) walked.push_back(samples[i]);
  if (walked.empty()) return false;
  const auto middle = static_cast<std::ptrdiff_t>(walked.size() / 2);
  const std::vector<plan::TargetSample> after(walked.begin() + middle, walked.end());
  const std::vector<plan::TargetSample> before(walked.rend() - middle - 1, walked.rend());
  int walks = 0, judged = 0;
  for (int start = 0; start < kStarts && walks < kMostWalks && judged < kMostJudged; ++start) {
    Numbers values = random_values();
    if (start == 0)
      for (const std::size_t i : moved_) values[i] = of_.middle_values[i];
    if (!reach(after[0], limits_, {kDepthShare, kEnough, start % 2 == 1}, values) ||
        !room_at(after[0], values))
      continue;
    ++walks;
    const std::vector<Numbers> there = walk(after, values);
    if (there.empty()) continue;
    std::vector<Numbers> track = walk(before, values);
    if (track.empty()) continue;
    std::reverse(track.begin(), track.end());
    track.insert(track.end(), there.begin() + 1, there.end());
    for (const double depth_share : {kDepthShareBetween, kDepthShare}) {
      const RobotTrajectory motion = motion_through(samples, track, depth_share);
      if (!is_free(samples, motion)) continue;
      ++judged;
      if (is_good(motion)) return true;
    }
  }
  return false;
}

}  // namespace sunder::bench
