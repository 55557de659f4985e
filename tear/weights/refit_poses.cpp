#include "tear/weights/refit_poses.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "core/internal/find_named.h"
#include "core/internal/ordered.h"
#include "core/internal/rotation_about.h"
#include "core/operation/internal/field_ranges.h"

namespace sunder::tear {
namespace {

constexpr int kRandomPoses = 96;
/// Most poses of the range of motion; of a larger one every n-th.
constexpr std::size_t kMostMotionPoses = 1024;
/// Largest random turn of a bone without limits, radians.
constexpr double kRandomTurn = 45.0 * std::numbers::pi / 180.0;

/// The poses over which a fit is judged: those of the options, all clips, and the range of motion.
PoseSetSpec all_poses(const RefitOptions& options) {
  PoseSetSpec all = options.poses;
  if (all.clip_samples == 0) all.clip_samples = PoseSetSpec{}.clip_samples;
  if (all.joint_limits.empty()) all.range_of_motion = true;
  return all;
}

bool counts_motion(const RefitOptions& options) {
  return options.poses.range_of_motion || !options.poses.joint_limits.empty();
}

double factor_of(const RefitImportance& importance, const Character& character, Index clip) {
  for (const RefitImportance::OfClip& of : importance.of_clip)
    if (find_clip(character, of.clip) == clip) return of.factor;
  return 1;
}

/// The importance of each clip; they add up to that of all clips.
std::vector<double> importance_of_clips(const Character& character, const RefitOptions& options) {
  std::vector<double> of_clips;
  double sum = 0;
  for (Index clip = 0; clip < character.clips.size(); ++clip)
    sum += of_clips.emplace_back(factor_of(options.importance, character, clip));
  const double all = options.poses.clip_samples > 0 ? options.importance.clips : 0.0;
  for (double& of_clip : of_clips) of_clip = sum > 0 ? all * of_clip / sum : 0.0;
  return of_clips;
}

/// Keeps every n-th pose, so that at most `most` remain.
void thin_out(std::size_t most, std::vector<std::size_t>& poses) {
  const std::size_t step = (poses.size() + most - 1) / most;
  if (step < 2) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < poses.size(); i += step) poses[kept++] = poses[i];
  poses.resize(kept);
}

/// Uniform in [-1, 1], with the same bits on every machine.
class Random {
 public:
  double next() {
    return static_cast<double>(engine_()) / static_cast<double>(std::mt19937::max()) * 2 - 1;
  }

 private:
  std::mt19937 engine_{20220510};
};

Quatd turn(double angle, const Vec3d& axis) { return rotation_about(angle, normalized(axis)); }

/// A rotation of a bone within its limits, or within kRandomTurn about a random axis.
Quatd random_turn(std::uint32_t bone, const std::vector<JointLimit>& limits, Random& random) {
  Quatd rotation = Quatd::Identity();
  bool is_limited = false;
  for (const JointLimit& limit : limits) {
    if (limit.bone != bone) continue;
    is_limited = true;
    const double share = 0.5 * (random.next() + 1);
    rotation =
        multiply(rotation, turn(limit.lower + share * (limit.upper - limit.lower), limit.axis));
  }
  if (is_limited) return rotation;
  const double angle = kRandomTurn * random.next();
  Vec3d axis = Vec3d::UnitX();
  for (int i = 0; i < 3; ++i) axis[i] = random.next();  // in this order with every compiler
  return turn(angle, axis);
}

}  // namespace

Status RefitPoses::check(const Character& character, const RefitOptions& options) {
  if (const Status status = PoseSet::check(character, options.poses); !status) return status;
  if (options.bound != 0)
    if (const Status status = field::kBound.check(options.bound); !status) return status;
  const RefitImportance& importance = options.importance;
  for (const auto& [name, number] :
       {std::pair("importance of clips", importance.clips),
        std::pair("importance of the range of motion", importance.range_of_motion),
        std::pair("importance of the given poses", importance.poses)})
    if (const Status status = field::importance(name).check(number); !status) return status;
  for (const RefitImportance::OfClip& of : importance.of_clip) {
    if (const Status status =
            field::importance(("importance of clip '" + of.clip.substr(0, 80) + "'").c_str())
                .check(of.factor);
        !status)
      return status;
    if (!find_clip(character, of.clip))
      return Status::failure(StatusCode::not_found, kNone,
                             "an importance is given for clip '%.80s', which does not exist",
                             of.clip.c_str());
  }
  return {};
}

RefitPoses::RefitPoses(std::shared_ptr<const Character> character, PoseSet set)
    : character_(std::move(character)), set_(std::move(set)) {}

Result<RefitPoses> RefitPoses::create(std::shared_ptr<const Character> character,
                                      const RefitOptions& options,
                                      const std::vector<bool>& moves_points) {
  Result<PoseSet> set = PoseSet::create(character, all_poses(options));
  if (!set) return set.error();
  RefitPoses poses(std::move(character), std::move(*set));
  poses.add_groups(options, moves_points);
  return poses;
}

/// The bones that move some of the points' bones and not others.
std::vector<bool> RefitPoses::bending_bones(const std::vector<bool>& moves_points) const {
  const auto& bones = character_->skeleton.bones;
  std::vector<std::size_t> below(bones.size(), 0);  // at and below each bone
  std::size_t all = 0;
  for (std::size_t bone = bones.size(); bone-- > 0;) {  // children before parents
    if (moves_points[bone]) ++below[bone], ++all;
    if (bones[bone].parent != kNone) below[bones[bone].parent] += below[bone];
  }
  std::vector<bool> bends(bones.size());
  for (std::size_t bone = 0; bone < bones.size(); ++bone)
    bends[bone] = below[bone] > 0 && below[bone] < all;
  return bends;
}

void RefitPoses::add_groups(const RefitOptions& options, const std::vector<bool>& moves_points) {
  using Source = PoseSet::Source;
  const std::vector<bool> bends = bending_bones(moves_points);
  const std::vector<double> of_clips = importance_of_clips(*character_, options);
  groups_.resize(1 + of_clips.size() + 2);
  for (std::size_t clip = 0; clip < of_clips.size(); ++clip)
    groups_[1 + clip].importance = of_clips[clip];
  Group& motion = groups_[1 + of_clips.size()];
  Group& given = groups_[2 + of_clips.size()];
  motion.importance = counts_motion(options) ? options.importance.range_of_motion : 0.0;
  given.importance = options.importance.poses;
  const auto bends_points = [&](std::uint32_t bone) { return bone != kNone && bends[bone]; };
  for (std::size_t i = 0; i < set_.size(PoseSet::Role::fit); ++i) {
    const PoseSet::Group of = set_.group_of(PoseSet::Role::fit, i);
    if (of.source == Source::clip) groups_[1 + of.clip].poses.push_back(i);
    if (of.source == Source::given) given.poses.push_back(i);
    if (of.source != Source::joints) continue;
    const auto turned = set_.turned_bones(PoseSet::Role::fit, i);
    if (bends_points(turned[0]) || bends_points(turned[1])) motion.poses.push_back(i);
  }
  thin_out(kMostMotionPoses, motion.poses);
  add_random_poses(options, bends);
  std::erase_if(groups_, [](const Group& group) { return group.poses.empty(); });
  double sum = 0;
  for (const Group& group : groups_) sum += group.importance;
  for (Group& group : groups_) group.importance /= sum > 0 ? sum : 1.0;
}

/// Adds the rest pose, as the first group, and poses in which all bones that bend the surface turn
/// at once: over the range of motion alone, in which one or two joints turn, a fit could rely on
/// the others being at rest.
void RefitPoses::add_random_poses(const RefitOptions& options, const std::vector<bool>& bends) {
  const auto& bones = character_->skeleton.bones;
  Pose rest;
  rest.morph_weights = character_->rest_morph_weights;
  for (const Bone& bone : bones) rest.parent_from_bone.push_back(bone.rest);
  const std::size_t first = set_.size(PoseSet::Role::fit);
  random_.assign(1, rest);
  groups_[0].poses = {first};
  if (std::find(bends.begin(), bends.end(), true) == bends.end()) return;
  Group group;
  Random random;
  for (int i = 0; i < kRandomPoses; ++i) {
    Pose& pose = random_.emplace_back(rest);
    for (std::uint32_t bone = 0; bone < bones.size(); ++bone) {
      if (!bends[bone]) continue;
      Quatf& rotation = pose.parent_from_bone[bone].rotation;
      rotation = normalized(multiply(rotation.cast<double>(),
                                     random_turn(bone, options.poses.joint_limits, random)))
                     .cast<float>();
    }
    group.poses.push_back(first + random_.size() - 1);
  }
  groups_.push_back(std::move(group));
}

double RefitPoses::weight_of(std::size_t pose) const {
  return pose < set_.size(PoseSet::Role::fit) ? set_.weight_of(pose) : 1.0;
}

Status RefitPoses::compute(std::size_t pose, ModelPose& result) const {
  const std::size_t first = set_.size(PoseSet::Role::fit);
  if (pose < first) return set_.compute(PoseSet::Role::fit, pose, result);
  return compute_model_pose(character_->skeleton, random_[pose - first], result);
}

}  // namespace sunder::tear
