#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "pipeline/plan/choose_tracks.h"
#include "pipeline/plan/find_obstacles.h"
#include "pipeline/plan/next_share.h"

namespace sunder::plan {
namespace {

constexpr std::size_t kWidth = 8;        ///< Places that are kept at an instant.
constexpr int kChildren = 6;             ///< That are tried from each of them.
constexpr std::uint32_t kFreeTries = 8;  ///< Random starts per wanted seed.
constexpr std::size_t kStarts = 24;      ///< That are walked from.
constexpr int kMostTried = 24'000;       ///< Places in a round.
constexpr int kRounds = 3;               ///< Each begins where the one before came no farther.
constexpr std::size_t kMostFreeTracks = 3;
constexpr double kOfSpeed = 0.85;      ///< Share of the limits of speed that a walk uses.
constexpr double kOfReach = 0.5;       ///< Share of the tolerance.
constexpr double kLeastHandle = 0.1;   ///< Cosine to the surface's normal.
constexpr double kRoomOfLimits = 0.2;  ///< Radians or metres that count as free.
constexpr double kLeanCost = 0.5;      ///< Room that a radian is worth.
constexpr double kStartLean = 0.8;     ///< Radians, about each axis at most.
constexpr double kSoftAngle = 1.0;     ///< Radians that count as one error.
constexpr double kLessLean = 0.7, kLargestStep = 0.3;
constexpr double kSameStart = 0.3;
constexpr std::uint64_t kWalkSeed = 0x3a1c;

/// A place of the walk.
struct Step {
  Values values;
  Eigen::Vector3d lean = Eigen::Vector3d::Zero();  ///< From the wanted handle; a rotation vector.
  double room = 0;
  std::size_t before = 0;  ///< In the layer before.
};

Vec3d leaned(const Vec3d& handle, const Eigen::Vector3d& lean) {
  const double angle = lean.norm();
  if (angle < 1e-12) return handle;
  return Eigen::AngleAxisd(angle, lean / angle) * Eigen::Vector3d(handle);
}

/// The least turn from one direction to another.
Eigen::Vector3d lean_of(const Vec3d& from, const Vec3d& to) {
  const Eigen::AngleAxisd turn(
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d(from), Eigen::Vector3d(to)));
  return turn.angle() * turn.axis();
}

class FreeWalk {
 public:
  FreeWalk(BladeChain& chain, const TrackSearch& search, const WalkRules& rules)
      : chain_(chain), search_(search), rules_(rules), state_(kWalkSeed + rules.seed) {}

  std::vector<Track> run() {
    std::size_t start = 0;
    while (start < last() && sample_at(start).share < 0.5) ++start;
    std::vector<Track> tracks;
    for (int round = 0; round < kRounds && tracks.empty(); ++round) {
      tracks = walk_from(start);
      if (farthest_ == start) break;  // nothing is free there
      start = farthest_;
    }
    return tracks;
  }

  bool has_start(std::size_t instant, std::uint32_t tries) {
    for (std::uint32_t i = 0; i <= tries; ++i) {
      Step start;
      if (settle_start(i, instant, start)) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] std::size_t last() const { return search_.clearance.instants() - 1; }

  /// Tracks that pass through free values at an instant.
  std::vector<Track> walk_from(std::size_t instant) {
    std::vector<Track> tracks;
    tried_ = 0;
    farthest_ = instant;
    for (const Step& start : starts_at(instant)) {
      std::vector<Step> after = walk(start, instant, last());
      if (after.empty()) continue;
      std::vector<Step> steps = walk(start, instant, 0);
      if (steps.empty()) continue;
      std::reverse(steps.begin(), steps.end());
      steps.insert(steps.end(), after.begin() + 1, after.end());
      tracks.push_back(track_of(steps));
      if (tracks.size() == kMostFreeTracks) break;
    }
    return tracks;
  }

  [[nodiscard]] const TargetSample& sample_at(std::size_t instant) const {
    return search_.samples[search_.clearance.sample_of(instant)];
  }

  double random(double most) { return most * (2 * next_share(state_) - 1); }

  /// The values of one random start. @return whether they are free.
  bool settle_start(std::uint32_t i, std::size_t instant, Step& start) {
    const Values rest = chain_.rest();
    start.values = i == 0 ? rest : random_values(rest, search_.limits.values, state_);
    if (i % 4 == 1) start.lean = {random(kStartLean), random(kStartLean), random(kStartLean)};
    const Lean kind = i % 4 == 2 ? Lean::little : i % 4 == 3 ? Lean::any : Lean::kept;
    return settle(instant, search_.limits.values, kind, start);
  }

  /// Different values for an instant that are free, those with the most room first.
  std::vector<Step> starts_at(std::size_t instant) {
    std::vector<Step> starts;
    for (std::uint32_t i = 0; i <= kFreeTries * search_.seeds; ++i) {
      Step start;
      if (!settle_start(i, instant, start)) continue;
      const bool is_known = std::any_of(starts.begin(), starts.end(), [&](const Step& other) {
        return (other.values - start.values).cwiseAbs().maxCoeff() < kSameStart;
      });
      if (!is_known) starts.push_back(std::move(start));
    }
    std::stable_sort(starts.begin(), starts.end(),
                     [](const Step& a, const Step& b) { return a.room > b.room; });
    if (starts.size() > kStarts) starts.resize(kStarts);
    return starts;
  }

  /// How much the direction of the blade counts: fully, less than all else, or not.
  enum class Lean : std::uint8_t { kept, little, any };

  /// Moves values to what the sample wants. @return whether they are free.
  bool settle(std::size_t instant, const ValueLimits& limits, Lean kind, Step& step) {
    ++tried_;
    TargetSample sample = sample_at(instant);
    const Vec3d wanted = sample.handle;
    sample.handle = leaned(wanted, step.lean);
    ErrorScales scales = search_.scales;
    if (kind == Lean::little) scales.angle = kSoftAngle;
    if (kind == Lean::any) scales.angle = std::numeric_limits<double>::infinity();
    solve_sample(chain_, sample, scales, limits, step.values);
    BladePlace blade;
    chain_.place({step.values.data(), chain_.size()}, blade, false);
    const Vec3d handle = (blade.base - blade.tip).normalized();
    const bool cuts = sample.depth > 0;
    if (cuts) {
      if (handle.dot(sample.normal) < kLeastHandle) return false;
      if (!is_reached(chain_, sample, step.values, kOfReach * search_.tolerance)) return false;
    }
    step.lean = lean_of(wanted, handle);
    if (!search_.clearance.is_blade_outside(instant, blade.base, cuts ? sample.place : blade.tip))
      return false;
    double distance = search_.margin;
    if (rules_.keeps_links_outside)
      distance = search_.clearance.least_distance(chain_, instant, step.values, 2 * search_.margin);
    if (distance <= 0) return false;
    double to_limits = kRoomOfLimits;
    const ValueLimits& all = search_.limits.values;
    for (Eigen::Index i = 0; i < step.values.size(); ++i)
      to_limits =
          std::min({to_limits, step.values[i] - all.lower[i], all.upper[i] - step.values[i]});
    step.room = std::min(1.0, distance / search_.margin) + 0.5 * to_limits / kRoomOfLimits -
                kLeanCost * step.lean.norm();
    return true;
  }

  /// Steps from a start to the last instant; empty if there is no way.
  std::vector<Step> walk(const Step& start, std::size_t from, std::size_t to) {
    std::vector<std::vector<Step>> layers = {{start}};
    for (std::size_t instant = from; instant != to;) {
      const std::size_t next = to > from ? instant + 1 : instant - 1;
      const double seconds =
          std::max(1e-9, std::abs(sample_at(next).time - sample_at(instant).time));
      std::vector<Step> layer;
      for (std::size_t i = 0; i < layers.back().size(); ++i)
        add_children(layers.back()[i], i, next, seconds, layer);
      if (layer.empty() || tried_ > kMostTried) {
        if (layer.empty()) stopped_at(next, from);
        return {};
      }
      layers.push_back(best_of(std::move(layer)));
      instant = next;
    }
    std::vector<Step> steps(layers.size());
    std::size_t at = 0;  // with the most room
    for (std::size_t i = layers.size(); i-- > 0;) {
      steps[i] = std::move(layers[i][at]);
      at = steps[i].before;
    }
    return steps;
  }

  /// Keeps the instant that the walks from `from` got to at most.
  void stopped_at(std::size_t instant, std::size_t from) {
    const auto away = [&](std::size_t of) { return of > from ? of - from : from - of; };
    if (away(instant) > away(farthest_)) farthest_ = instant;
  }

  void add_children(const Step& parent, std::size_t index, std::size_t instant, double seconds,
                    std::vector<Step>& layer) {
    const Values most = (kOfSpeed * rules_.speed * seconds * search_.limits.speed).eval();
    const ValueLimits near = {(parent.values - most).cwiseMax(search_.limits.values.lower),
                              (parent.values + most).cwiseMin(search_.limits.values.upper)};
    for (int child = 0; child < kChildren; ++child) {
      Step step{parent.values, parent.lean, 0, index};
      if (child == 1) step.lean *= kLessLean;
      if (child > 2)
        for (Eigen::Index i = 0; i < most.size(); ++i)
          step.values[i] += random(0.5 * std::min(most[i], kLargestStep));
      const Lean kind = child < 2 ? Lean::kept : child == 3 ? Lean::little : Lean::any;
      if (kind == Lean::little) step.lean = Eigen::Vector3d::Zero();
      if (settle(instant, near, kind, step)) layer.push_back(std::move(step));
    }
  }

  /// Half of those that are kept have the most room, the others are any.
  std::vector<Step> best_of(std::vector<Step> layer) {
    std::stable_sort(layer.begin(), layer.end(),
                     [](const Step& a, const Step& b) { return a.room > b.room; });
    for (std::size_t i = kWidth / 2; i < kWidth && i + 1 < layer.size(); ++i) {
      const auto left = static_cast<double>(layer.size() - i);
      std::swap(layer[i], layer[i + static_cast<std::size_t>(left * next_share(state_))]);
    }
    if (layer.size() > kWidth) layer.resize(kWidth);
    return layer;
  }

  /// Between instants values and leans are interpolated, and values settle.
  [[nodiscard]] Track track_of(const std::vector<Step>& steps) const {
    Track track;
    const Clearance& clearance = search_.clearance;
    for (std::size_t i = 0, next = 1; i < search_.samples.size(); ++i) {
      while (next + 1 < steps.size() && clearance.sample_of(next) < i) ++next;
      const double begin = sample_at(next - 1).time, end = sample_at(next).time;
      const double share =
          end > begin ? std::clamp((search_.samples[i].time - begin) / (end - begin), 0.0, 1.0) : 0;
      const Step &a = steps[next - 1], &b = steps[next];
      TargetSample sample = search_.samples[i];
      sample.handle = leaned(sample.handle, (1 - share) * a.lean + share * b.lean);
      Values values = (1 - share) * a.values + share * b.values;
      solve_sample(chain_, sample, search_.scales, search_.limits.values, values);
      track.values.push_back(std::move(values));
      track.handles.push_back(sample.handle);
    }
    return track;
  }

  BladeChain& chain_;
  const TrackSearch& search_;
  const WalkRules& rules_;
  std::uint64_t state_;
  std::size_t farthest_ = 0;
  int tried_ = 0;
};

}  // namespace

std::vector<Track> walk_freely(BladeChain& chain, const TrackSearch& search,
                               const WalkRules& rules) {
  return FreeWalk(chain, search, rules).run();
}

bool has_free_values(BladeChain& chain, const TrackSearch& search, std::size_t instant,
                     std::uint32_t tries) {
  const WalkRules rules;
  return FreeWalk(chain, search, rules).has_start(instant, tries);
}

}  // namespace sunder::plan
