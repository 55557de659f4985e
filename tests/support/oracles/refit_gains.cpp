#include "support/oracles/refit_gains.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "support/models/rigs.h"

namespace sunder::test {
namespace {

constexpr int kTears = 4;
constexpr std::uint32_t kInfluences = 4;
constexpr int kPosesOfClip = 12;
constexpr int kRandomPoses = 200;
/// Smaller errors, as shares of the diagonal, are rounding: positions are stored in float.
constexpr double kNothing = 2e-7;
/// A lower gain is a loss.
constexpr double kLeastGain = 1 - 1e-9;

template <class T>
T value_or_abort(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().text().data());
    std::abort();
  }
  return std::move(*result);
}

ModelPose pose_of_clip(const Character& character, std::uint32_t clip, double share) {
  const double duration = static_cast<double>(character.clips[clip].duration);
  return value_or_abort(make_pose(character, ClipPose{clip, share * duration}));
}

ModelPose pose_to_tear_in(const Character& character, Random& random) {
  if (character.clips.empty()) return random_pose(character, random);
  const auto clips = static_cast<std::uint32_t>(character.clips.size());
  return pose_of_clip(character, random.index(clips), random.uniform(0, 1));
}

/// The poses of a group, and what they are.
struct Poses {
  GroupGain::Kind kind;
  std::vector<ModelPose> poses;
};

std::vector<Poses> held_out_poses(const std::shared_ptr<const Character>& character,
                                  std::vector<ModelPose> of_operations, Random& random) {
  using Kind = GroupGain::Kind;
  std::vector<Poses> groups;
  for (std::uint32_t clip = 0; clip < character->clips.size(); ++clip) {
    Poses& group = groups.emplace_back(Poses{Kind::clip, {}});
    for (int i = 0; i < kPosesOfClip; ++i)
      group.poses.push_back(
          pose_of_clip(*character, clip, (i + random.uniform(0, 1)) / kPosesOfClip));
  }
  groups.push_back({Kind::rest, {value_or_abort(make_pose(*character, RestPose{}))}});
  groups.push_back({Kind::operation, std::move(of_operations)});
  PoseSetSpec motion;
  motion.clip_samples = 0;
  motion.range_of_motion = true;
  if (const auto set = PoseSet::create(character, motion)) {
    Poses& group = groups.emplace_back(Poses{Kind::range_of_motion, {}});
    for (std::size_t i = 0; i < set->size(PoseSet::Role::held_out); ++i)
      if (!set->compute(PoseSet::Role::held_out, i, group.poses.emplace_back())) std::abort();
  }
  Poses& group = groups.emplace_back(Poses{Kind::random, {}});
  for (int i = 0; i < kRandomPoses; ++i)
    group.poses.push_back(random_pose(*character, random, 0.7, 1.0));
  return groups;
}

/// Errors over a group of poses, metres.
using Errors = WeightErrors::Statistics;

/// The errors in the pose of each operation of its own points.
Errors errors_of_operations(const TornModel& model, const std::vector<ModelPose>& poses) {
  Errors errors;
  double sum = 0, count = 0;
  for (std::uint32_t i = 0; i < poses.size(); ++i) {
    const auto of = measure_weight_errors(model, i, 1, {&poses[i], 1});
    if (!of) continue;  // it created no point
    const auto points = static_cast<double>(of->points.size());
    sum += points * of->metres.rms * of->metres.rms;
    count += points;
    errors.percentile95 = std::max(errors.percentile95, of->metres.percentile95);
    errors.maximum = std::max(errors.maximum, of->metres.maximum);
  }
  errors.rms = count > 0 ? std::sqrt(sum / count) : 0.0;
  return errors;
}

/// The errors over each group.
std::vector<Errors> errors_over(const TornModel& model, const std::vector<Poses>& groups,
                                std::uint32_t operations) {
  std::vector<Errors> errors;
  for (const Poses& group : groups)
    errors.push_back(
        group.kind == GroupGain::Kind::operation
            ? errors_of_operations(model, group.poses)
            : value_or_abort(measure_weight_errors(model, 0, operations, group.poses)).metres);
  return errors;
}

WeightsOperation weights_of(WeightPolicy policy, std::uint32_t operations) {
  WeightsOperation wanted;
  wanted.operation_count = operations;
  wanted.weights = {policy, kInfluences};
  wanted.refit.poses.range_of_motion = true;
  return wanted;
}

}  // namespace

double RefitGains::least() const {
  double least = 1e300;
  for (const GroupGain& group : groups) least = std::min(least, group.gain);
  return least;
}

std::size_t RefitGains::lost() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      groups, [](const GroupGain& group) { return group.gain < kLeastGain; }));
}

double RefitGains::median(GroupGain::Kind kind, double GroupGain::*gain) const {
  std::vector<double> gains;
  for (const GroupGain& group : groups)
    if (group.kind == kind && group.barycentric > kNothing) gains.push_back(group.*gain);
  if (gains.empty()) return 0;
  std::sort(gains.begin(), gains.end());
  return 0.5 * (gains[(gains.size() - 1) / 2] + gains[gains.size() / 2]);
}

RefitGains measure_refit_gains(std::string name, const std::shared_ptr<const Character>& character,
                               std::uint64_t seed) {
  RefitGains result{std::move(name), seed, 0, 0, 0, {}};
  Random random(seed);
  TornModel model = value_or_abort(TornModel::create(character));
  std::vector<ModelPose> of_operations;
  for (int attempt = 0; attempt < 60 && of_operations.size() < kTears; ++attempt) {
    const ModelPose pose = pose_to_tear_in(*character, random);
    const auto report = model.tear(pose, random_stroke(*character, pose, random));
    if (!report || report->runs == 0) {
      if (report) (void)model.undo();
      continue;
    }
    of_operations.push_back(pose);
  }
  const auto operations = static_cast<std::uint32_t>(of_operations.size());
  if (operations == 0) return result;
  const double diagonal = posed_diagonal(*character, *rest_pose(*character));
  const auto groups = held_out_poses(character, std::move(of_operations), random);
  result.points =
      value_or_abort(model.reweigh(weights_of(WeightPolicy::barycentric, operations))).points;
  const auto before = errors_over(model, groups, operations);
  if (!model.undo()) std::abort();
  const auto start = std::chrono::steady_clock::now();
  result.refitted =
      value_or_abort(model.reweigh(weights_of(WeightPolicy::refit, operations))).refitted;
  const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
  result.microseconds = time.count() / static_cast<double>(std::max<std::size_t>(result.points, 1));
  const auto after = errors_over(model, groups, operations);
  const auto ratio = [&](double of_before, double of_after) {
    const double nothing = kNothing * diagonal;
    return std::max(of_before, nothing) / std::max(of_after, nothing);
  };
  for (std::size_t i = 0; i < groups.size(); ++i)
    result.groups.push_back({groups[i].kind, ratio(before[i].rms, after[i].rms),
                             ratio(before[i].percentile95, after[i].percentile95),
                             ratio(before[i].maximum, after[i].maximum), before[i].rms / diagonal});
  return result;
}

}  // namespace sunder::test
