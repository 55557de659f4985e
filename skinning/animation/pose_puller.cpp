#include <sunder/animation/pull.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/internal/elementary.h"
#include "core/internal/out_of_memory.h"
#include "skinning/animation/internal/limit_of_bones.h"
#include "skinning/animation/pull_chain.h"
#include "skinning/animation/pull_solver.h"
#include "skinning/internal/rotation.h"

namespace sunder {

using animation::JointRange;
using animation::PullChain;
using animation::PullJoint;
using animation::PullSolver;

namespace {

constexpr std::size_t kMostTargets = 8;
/// Rotations that leave their limits by less are within, radians: so much does rounding to float.
constexpr double kWithin = 1e-6;

Status no_bone(std::uint32_t bone, std::size_t count) {
  return Status::failure(StatusCode::index_out_of_range, bone,
                         "bone %u does not exist; the skeleton has %zu", bone, count);
}

Status check_bones(const Skeleton& skeleton, std::span<const std::uint32_t> bones,
                   std::span<const float> stiffness) {
  const std::size_t count = skeleton.bones.size();
  if (bones.empty())
    return Status::failure(StatusCode::empty_input, kNone, "no bone of the chain may turn");
  if (!stiffness.empty() && stiffness.size() != bones.size())
    return Status::failure(StatusCode::size_mismatch, kNone, "%zu bones have %zu stiffnesses",
                           bones.size(), stiffness.size());
  for (std::uint32_t i = 0; i < bones.size(); ++i) {
    if (bones[i] >= count) return no_bone(bones[i], count);
    if (!stiffness.empty() && !(std::isfinite(stiffness[i]) && stiffness[i] >= 0.0f))
      return Status::failure(StatusCode::invalid_argument, i,
                             "the stiffness of bone %u is %g, but must be finite and >= 0",
                             bones[i], static_cast<double>(stiffness[i]));
  }
  return {};
}

/// The joints in the order of the bones. @return as limit_of_bones(); invalid_argument for a bone
/// that is given twice.
Result<std::vector<PullJoint>> make_joints(const Skeleton& skeleton,
                                           std::span<const std::uint32_t> bones,
                                           std::span<const BoneLimit> limits,
                                           std::span<const float> stiffness) {
  const Result<std::vector<const BoneLimit*>> limit_of =
      animation::limit_of_bones(limits, skeleton.bones.size());
  if (!limit_of) return limit_of.error();
  std::vector<bool> is_listed(skeleton.bones.size(), false);
  std::vector<PullJoint> joints;
  for (std::size_t i = 0; i < bones.size(); ++i) {
    if (is_listed[bones[i]])
      return Status::failure(StatusCode::invalid_argument, bones[i],
                             "bone %u is in the chain twice", bones[i]);
    is_listed[bones[i]] = true;
    PullJoint& joint = joints.emplace_back();
    joint.bone = bones[i];
    if (!stiffness.empty()) joint.readiness = 1.0 / (1.0 + static_cast<double>(stiffness[i]));
    if (const BoneLimit* const limit = (*limit_of)[bones[i]])
      joint.range =
          JointRange(*limit, unit(Quatd(skeleton.bones[bones[i]].rest.rotation.cast<double>())));
  }
  return joints;
}

Status check_target(const PullTarget& target, std::uint32_t index, std::size_t bones) {
  if (target.handle == nullptr || target.handle->parts.empty())
    return Status::failure(StatusCode::empty_input, index, "target %u has no handle", index);
  if (!target.place.allFinite())
    return Status::failure(StatusCode::non_finite_value, index, "target %u is not finite", index);
  if (!std::isfinite(target.weight) || !(target.weight > 0.0))
    return Status::failure(StatusCode::invalid_argument, index,
                           "the weight of target %u is %g, but must be > 0", index, target.weight);
  for (const PullHandle::Part& part : target.handle->parts) {
    if (part.bone >= bones) return no_bone(part.bone, bones);
    if (!part.point.allFinite() || !std::isfinite(part.weight))
      return Status::failure(StatusCode::non_finite_value, index,
                             "the handle of target %u is not finite", index);
  }
  return {};
}

Status check_pull(std::span<const PullTarget> targets, const Pose& pose, std::size_t bones,
                  const PullOptions& options) {
  if (targets.empty())
    return Status::failure(StatusCode::empty_input, kNone, "there is no target to pull to");
  if (targets.size() > kMostTargets)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "there are %zu targets, but at most %zu are possible", targets.size(),
                           kMostTargets);
  if (pose.parent_from_bone.size() != bones)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu bones, the skeleton has %zu",
                           pose.parent_from_bone.size(), bones);
  if (!(options.tolerance > 0.0) || options.iterations == 0 || options.attempts == 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the tolerance, the iterations and the attempts must be > 0");
  for (std::uint32_t i = 0; i < targets.size(); ++i)
    if (const Status status = check_target(targets[i], i, bones); !status) return status;
  return {};
}

/// Radians between two rotations.
double angle_between(const Quatd& a, const Quatd& b) {
  const Vec4d chord = a.coeffs() - b.coeffs(), other = a.coeffs() + b.coeffs();
  return 4.0 * elementary::asin(std::min(0.5 * std::min(norm(chord), norm(other)), 1.0));
}

}  // namespace

struct PosePuller::State {
  std::size_t bone_count;
  PullChain chain;
  PullSolver solver;
  std::vector<Quatd> start;  ///< Per active joint, before it was put within its limits.

  /// @return whether any rotation was outside of its limits.
  bool put_within_limits();
  [[nodiscard]] bool has_turned(std::size_t joint) const;
  void write(Pose& pose) const;
};

bool PosePuller::State::put_within_limits() {
  bool has_changed = false;
  start.clear();
  for (const std::uint32_t node : chain.active()) {
    const Quatd now = chain.rotation(node), within = chain.joint(node).range.clamped(now);
    start.push_back(now);
    if (angle_between(now, within) <= kWithin) continue;
    chain.set_rotation(node, within);
    has_changed = true;
  }
  return has_changed;
}

bool PosePuller::State::has_turned(std::size_t joint) const {
  return chain.rotation(chain.active()[joint]).coeffs() != start[joint].coeffs();
}

void PosePuller::State::write(Pose& pose) const {
  const auto active = chain.active();
  for (std::size_t j = 0; j < active.size(); ++j)
    if (has_turned(j))
      pose.parent_from_bone[chain.bone(active[j])].rotation =
          chain.rotation(active[j]).cast<float>();
}

Result<PosePuller> PosePuller::create(const Skeleton& skeleton,
                                      std::span<const std::uint32_t> bones,
                                      std::span<const BoneLimit> limits,
                                      std::span<const float> stiffness) {
  if (const Status status = check_bones(skeleton, bones, stiffness); !status) return status;
  return or_out_of_memory([&]() -> Result<PosePuller> {
    Result<std::vector<PullJoint>> joints = make_joints(skeleton, bones, limits, stiffness);
    if (!joints) return joints.error();
    std::vector<std::uint32_t> parents;
    parents.reserve(skeleton.bones.size());
    for (const Bone& bone : skeleton.bones) parents.push_back(bone.parent);
    return PosePuller(std::unique_ptr<State>(
        new State{parents.size(), PullChain(parents, std::move(*joints)), {}, {}}));
  });
}

PosePuller::PosePuller(std::unique_ptr<State> state) : state_(std::move(state)) {}
PosePuller::~PosePuller() = default;
PosePuller::PosePuller(PosePuller&&) noexcept = default;
PosePuller& PosePuller::operator=(PosePuller&&) noexcept = default;

Result<PullReport> PosePuller::pull(std::span<const PullTarget> targets, Pose& pose,
                                    const PullOptions& options) {
  State& state = *state_;
  if (const Status status = check_pull(targets, pose, state.bone_count, options); !status)
    return status;
  return or_out_of_memory([&]() -> Result<PullReport> {
    PullChain& chain = state.chain;
    if (const Status status = chain.start(pose, targets); !status) return status;
    const bool was_outside = state.put_within_limits();
    PullReport report;
    report.error_before = chain.measure();
    if (!std::isfinite(report.error_before))
      return Status::failure(StatusCode::non_finite_value, kNone,
                             "the pull is too large for numbers: the pose or the target");
    report.error = state.solver.solve(chain, options);
    report.iterations = state.solver.iterations();
    // The error of what is written, in float.
    const auto active = chain.active();
    for (std::size_t j = 0; j < active.size(); ++j)
      if (state.has_turned(j))
        chain.set_rotation(
            active[j], unit(Quatd(Quatf(chain.rotation(active[j]).cast<float>()).cast<double>())));
    report.error = chain.measure();
    if (report.error < report.error_before || was_outside)
      state.write(pose);
    else
      report.error = report.error_before;
    report.is_reached = report.error <= options.tolerance;
    return report;
  });
}

Result<PullReport> pull_point(const Skeleton& skeleton, std::span<const std::uint32_t> bones,
                              const PullHandle& handle, const Vec3d& place, Pose& pose,
                              const PullOptions& options) {
  Result<PosePuller> puller = PosePuller::create(skeleton, bones);
  if (!puller) return puller.error();
  const PullTarget target = {&handle, place, 1.0};
  return puller->pull({&target, 1}, pose, options);
}

}  // namespace sunder
