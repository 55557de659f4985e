#include <sunder/skinning/pose.h>

#include <cmath>
#include <new>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "skinning/clip_motion.h"
#include "skinning/clip_sampler.h"
#include "skinning/joint_sweeps.h"

namespace sunder {
namespace {

constexpr Index kMaximumClipSamples = 65'536;

struct ClipTime {
  Index clip = 0;
  double time = 0;  // seconds
};

Status validate_limit(const JointLimit& limit, Index index, std::size_t bone_count) {
  if (limit.bone >= bone_count)
    return Status::failure(StatusCode::index_out_of_range, index,
                           "joint limit %u: bone %u does not exist; the skeleton has %zu bones",
                           index, limit.bone, bone_count);
  if (!limit.axis.allFinite() || !std::isfinite(limit.lower) || !std::isfinite(limit.upper))
    return Status::failure(StatusCode::non_finite_value, index,
                           "joint limit %u: axis and angles must be finite", index);
  if (limit.axis.isZero(0))
    return Status::failure(StatusCode::invalid_argument, index,
                           "joint limit %u: the axis has no length", index);
  if (limit.lower > limit.upper)
    return Status::failure(StatusCode::invalid_argument, index,
                           "joint limit %u: lower %g is above upper %g", index, limit.lower,
                           limit.upper);
  return {};
}

Result<ModelPose> make_given_pose(const Character& character, const PoseSpec& spec, Index index) {
  Result<ModelPose> pose = make_pose(character, spec);
  if (!pose)
    return Status::failure(pose.error().code(), index, "given pose %u: %s", index,
                           pose.error().text().data());
  for (const Affine3d& model_from_bone : pose->model_from_bone)
    if (!model_from_bone.matrix().allFinite())
      return Status::failure(StatusCode::non_finite_value, index,
                             "given pose %u: a bone is not finite", index);
  for (const float weight : pose->morph_weights)
    if (!std::isfinite(weight))
      return Status::failure(StatusCode::non_finite_value, index,
                             "given pose %u: a morph weight is not finite", index);
  return pose;
}

}  // namespace

struct PoseSet::State {
  State(std::shared_ptr<const Character> from, const PoseSetSpec& spec)
      : character(std::move(from)), sweeps(skinning::make_joint_sweeps(*character, spec)) {
    if (spec.clip_samples == 0) return;
    const auto times_of = skinning::times_of_clips(*character, spec.clip_samples);
    for (Index clip = 0; clip < character->clips.size(); ++clip) {
      samplers.emplace_back(character->clips[clip]);
      for (const double time : times_of[clip].fit) fit_times.push_back({clip, time});
      durations.insert(durations.end(), times_of[clip].durations.begin(),
                       times_of[clip].durations.end());
      for (const double time : times_of[clip].held_out) held_out_times.push_back({clip, time});
    }
  }

  [[nodiscard]] const std::vector<ClipTime>& times(Role role) const {
    return role == Role::fit ? fit_times : held_out_times;
  }
  [[nodiscard]] const std::vector<skinning::Sweep>& sweeps_of(Role role) const {
    return role == Role::fit ? sweeps.fit : sweeps.held_out;
  }
  [[nodiscard]] std::size_t given_count(Role role) const {
    return role == Role::fit ? given.size() - given.size() / 4 : given.size() / 4;
  }
  /// Every fourth given pose is held out.
  [[nodiscard]] const ModelPose& given_of(Role role, std::size_t index) const {
    return role == Role::fit ? given[index + index / 3] : given[4 * index + 3];
  }

  void compute(Role role, std::size_t index, ModelPose& pose) const {
    const auto& clip_times = times(role);
    if (index < clip_times.size()) {
      const auto [clip, time] = clip_times[index];
      return samplers[clip].sample(*character, character->clips[clip], time, pose);
    }
    index -= clip_times.size();
    const auto& of_role = sweeps_of(role);
    if (index < of_role.size())
      return skinning::compute_sweep(*character, sweeps, of_role[index], pose);
    pose = given_of(role, index - of_role.size());
  }

  std::shared_ptr<const Character> character;
  std::vector<skinning::ClipSampler> samplers;  // per clip, if clips are sampled
  std::vector<ClipTime> fit_times, held_out_times;
  std::vector<double> durations;  // per fit time
  skinning::JointSweeps sweeps;
  std::vector<ModelPose> given;
};

PoseSet::PoseSet(std::shared_ptr<const State> state) : state_(std::move(state)) {}

Status PoseSet::check(const Character& character, const PoseSetSpec& spec) {
  if (spec.clip_samples > kMaximumClipSamples)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "%u samples per clip; the maximum is %u", spec.clip_samples,
                           kMaximumClipSamples);
  for (Index i = 0; i < spec.joint_limits.size(); ++i)
    if (const Status status =
            validate_limit(spec.joint_limits[i], i, character.skeleton.bones.size());
        !status)
      return status;
  for (Index clip = 0; clip < character.clips.size(); ++clip)
    if (!std::isfinite(character.clips[clip].duration))
      return Status::failure(StatusCode::non_finite_value, clip,
                             "clip %u '%.80s': its duration is not finite", clip,
                             character.clips[clip].name.c_str());
  return or_out_of_memory([&]() -> Status {
    for (Index i = 0; i < spec.poses.size(); ++i)
      if (const auto pose = make_given_pose(character, spec.poses[i], i); !pose)
        return pose.error();
    if (!spec.poses.empty() || (spec.clip_samples > 0 && !character.clips.empty()) ||
        !skinning::make_joint_sweeps(character, spec).fit.empty())
      return {};
    return Status::failure(
        StatusCode::empty_input, kNone,
        "no pose to fit over: %u samples per clip, %zu clips, no joint that rotates, no given pose",
        spec.clip_samples, character.clips.size());
  });
}

Result<PoseSet> PoseSet::create(std::shared_ptr<const Character> character,
                                const PoseSetSpec& spec) {
  if (!character) return Status::failure(StatusCode::empty_input, kNone, "the character is null");
  if (const Status status = validate_character(*character); !status) return status;
  if (const Status status = check(*character, spec); !status) return status;
  try {
    const auto state = std::make_shared<State>(std::move(character), spec);
    for (Index i = 0; i < spec.poses.size(); ++i) {
      Result<ModelPose> pose = make_given_pose(*state->character, spec.poses[i], i);
      if (!pose) return pose.error();
      state->given.push_back(std::move(*pose));
    }
    return PoseSet(state);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

std::size_t PoseSet::size(Role role) const {
  return state_->times(role).size() + state_->sweeps_of(role).size() + state_->given_count(role);
}

PoseSet::Group PoseSet::group_of(Role role, std::size_t index) const {
  SUNDER_ASSERT(index < size(role));
  const auto& clip_times = state_->times(role);
  if (index < clip_times.size()) return {Source::clip, clip_times[index].clip};
  return {
      index - clip_times.size() < state_->sweeps_of(role).size() ? Source::joints : Source::given,
      kNone};
}

double PoseSet::weight_of(std::size_t index) const {
  SUNDER_ASSERT(index < size(Role::fit));
  return index < state_->durations.size() ? state_->durations[index] : 1.0;
}

std::array<std::uint32_t, 2> PoseSet::turned_bones(Role role, std::size_t index) const {
  SUNDER_ASSERT(group_of(role, index).source == Source::joints);
  const State& state = *state_;
  const skinning::Sweep& sweep = state.sweeps_of(role)[index - state.times(role).size()];
  const auto bone_of = [&](const skinning::Turn& turn) {
    return turn.hinge == kNone ? kNone : state.sweeps.hinges[turn.hinge].bone;
  };
  return {bone_of(sweep.bone), bone_of(sweep.parent)};
}

Status PoseSet::compute(Role role, std::size_t index, ModelPose& pose) const {
  const State& state = *state_;
  SUNDER_ASSERT(index < size(role));
  return or_out_of_memory([&]() -> Status {
    pose.model_from_bone.reserve(state.character->skeleton.bones.size());
    pose.morph_weights.reserve(state.character->rest_morph_weights.size());
    state.compute(role, index, pose);
    return {};
  });
}

}  // namespace sunder
