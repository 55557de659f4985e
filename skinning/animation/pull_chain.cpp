#include "skinning/animation/pull_chain.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "skinning/internal/rotation.h"

namespace sunder::animation {

PullChain::PullChain(std::vector<std::uint32_t> parents, std::vector<PullJoint> joints)
    : parents_(std::move(parents)),
      joints_(std::move(joints)),
      joint_of_bone_(parents_.size(), kNone),
      node_of_bone_(parents_.size(), kNone) {
  for (std::uint32_t i = 0; i < joints_.size(); ++i) joint_of_bone_[joints_[i].bone] = i;
}

/// The bones of the handles and all above them, ascending.
void PullChain::collect(std::span<const PullTarget> targets) {
  for (const std::uint32_t bone : bones_) node_of_bone_[bone] = kNone;
  bones_.clear();
  for (const PullTarget& target : targets)
    for (const PullHandle::Part& part : target.handle->parts)
      for (std::uint32_t bone = part.bone; bone != kNone && node_of_bone_[bone] == kNone;
           bone = parents_[bone]) {
        bones_.push_back(bone);
        node_of_bone_[bone] = 0;
      }
  std::sort(bones_.begin(), bones_.end());
  for (std::uint32_t i = 0; i < bones_.size(); ++i) node_of_bone_[bones_[i]] = i;
}

Status PullChain::start(const Pose& pose, std::span<const PullTarget> targets) {
  collect(targets);
  nodes_.resize(bones_.size());
  active_.clear();
  for (std::uint32_t i = 0; i < bones_.size(); ++i) {
    Node& node = nodes_[i];
    const BoneTransform& local = pose.parent_from_bone[bones_[i]];
    if (!local.translation.allFinite() || !local.rotation.coeffs().allFinite() ||
        !local.scale.allFinite())
      return Status::failure(StatusCode::non_finite_value, bones_[i],
                             "the pose of bone %u is not finite", bones_[i]);
    const std::uint32_t parent = parents_[bones_[i]];
    node.bone = bones_[i];
    node.parent = parent == kNone ? kNone : node_of_bone_[parent];
    node.joint = joint_of_bone_[bones_[i]];
    node.place = kNone;
    node.translation = local.translation.cast<double>();
    node.scale = local.scale.cast<double>();
    set_rotation(i, unit(Quatd(local.rotation.cast<double>())));
    if (node.joint == kNone) continue;
    node.place = static_cast<std::uint32_t>(active_.size());
    active_.push_back(i);
  }
  double sum = 0;
  for (const PullTarget& target : targets) sum += target.weight;
  targets_.clear();
  for (const PullTarget& target : targets)
    targets_.push_back({target.place, std::sqrt(target.weight / sum), target.handle});
  errors_.resize(targets.size());
  return {};
}

void PullChain::set_rotation(std::uint32_t node, const Quatd& rotation) {
  nodes_[node].rotation = rotation;
  nodes_[node].matrix = rotation.toRotationMatrix();
}

/// From the bone's frame to that of its parent, without the translation.
Vec3d PullChain::lifted(const Node& node, const Vec3d& point) const {
  return multiply(node.matrix, Vec3d(node.scale.cwiseProduct(point)));
}

double PullChain::measure() {
  double sum = 0;
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    Vec3d handle = Vec3d::Zero();
    for (const PullHandle::Part& part : targets_[t].handle->parts) {
      Vec3d point = part.point;
      for (std::uint32_t i = node_of_bone_[part.bone]; i != kNone; i = nodes_[i].parent)
        point = lifted(nodes_[i], point) + nodes_[i].translation;
      handle += part.weight * point;
    }
    errors_[t] = targets_[t].root_of_weight * (targets_[t].place - handle);
    sum += squared_norm(errors_[t]);
  }
  return std::sqrt(sum);
}

void PullChain::differentiate() {
  for (Node& node : nodes_) {
    if (node.parent == kNone) {
      node.model_from_parent = Mat3d::Identity();
      continue;
    }
    const Node& parent = nodes_[node.parent];
    const Mat3d scaled = parent.matrix * parent.scale.asDiagonal();
    node.model_from_parent = multiply(parent.model_from_parent, scaled);
  }
  derivatives_.assign(targets_.size() * active_.size(), Mat3d::Zero());
  for (std::size_t t = 0; t < targets_.size(); ++t)
    for (const PullHandle::Part& part : targets_[t].handle->parts) differentiate(t, part);
}

/// A turn of a bone by a small vector w moves a point at v from its origin by w x v.
void PullChain::differentiate(std::size_t target, const PullHandle::Part& part) {
  const double factor = targets_[target].root_of_weight * part.weight;
  Vec3d point = part.point;
  for (std::uint32_t i = node_of_bone_[part.bone]; i != kNone; i = nodes_[i].parent) {
    const Node& node = nodes_[i];
    const Vec3d v = lifted(node, point);
    if (node.place != kNone) {
      Mat3d cross;
      cross << 0, v.z(), -v.y(), -v.z(), 0, v.x(), v.y(), -v.x(), 0;
      derivatives_[target * active_.size() + node.place] +=
          factor * multiply(node.model_from_parent, cross);
    }
    point = v + node.translation;
  }
}

bool PullChain::is_stretched() const {
  if (targets_.size() != 1 || targets_[0].handle->parts.size() != 1 || active_.empty())
    return false;
  const PullHandle::Part& part = targets_[0].handle->parts[0];
  Vec3d point = part.point, previous = part.point;
  double reach = 0;
  std::uint32_t top = kNone;
  Vec3d origin = Vec3d::Zero();
  // `previous` is the joint below, or the handle, in the frame that `point` is in.
  for (std::uint32_t i = node_of_bone_[part.bone]; i != kNone; i = nodes_[i].parent) {
    const Node& node = nodes_[i];
    point = lifted(node, point) + node.translation;
    previous = lifted(node, previous) + node.translation;
    if (top != kNone) origin = lifted(node, origin) + node.translation;
    if (node.place == kNone) continue;
    reach += norm(multiply(node.model_from_parent, Vec3d(previous - node.translation)));
    previous = node.translation;
    origin = node.translation;
    top = i;
  }
  const Vec3d arm = point - origin;
  const Vec3d beyond = targets_[0].place - point;
  return norm(arm) >= 0.9999 * reach && dot(arm, beyond) >= 0.0;
}

}  // namespace sunder::animation
