#pragma once

#include <sunder/animation/pull.h>

#include <cstdint>
#include <span>
#include <vector>

#include "skinning/animation/joint_range.h"

namespace sunder::animation {

/// A bone that may turn.
struct PullJoint {
  std::uint32_t bone = 0;
  JointRange range;
  double readiness = 1.0;  ///< 1 / (1 + stiffness).
};

/// The bones above the handles of a pull, with their rotations as they change: forward kinematics
/// of the handles, and their derivatives by the joints. Everything is in double.
class PullChain {
 public:
  /// @param parents  of each bone of the skeleton.
  /// @param joints   kept; at most one per bone.
  PullChain(std::vector<std::uint32_t> parents, std::vector<PullJoint> joints);

  /// Takes the bones above the handles from a pose. @return the first fault of their transforms.
  [[nodiscard]] Status start(const Pose& pose, std::span<const PullTarget> targets);

  [[nodiscard]] std::size_t target_count() const { return targets_.size(); }
  /// Joints above a handle; the others cannot help. @return indices of nodes.
  [[nodiscard]] std::span<const std::uint32_t> active() const { return active_; }
  [[nodiscard]] const PullJoint& joint(std::uint32_t node) const {
    return joints_[nodes_[node].joint];
  }
  [[nodiscard]] std::uint32_t bone(std::uint32_t node) const { return nodes_[node].bone; }
  [[nodiscard]] const Quatd& rotation(std::uint32_t node) const { return nodes_[node].rotation; }
  void set_rotation(std::uint32_t node, const Quatd& rotation);

  /// From the handles to their targets, each times the root of its share of the weight.
  /// @return its length: the error.
  double measure();
  [[nodiscard]] std::span<const Vec3d> errors() const { return errors_; }

  /// Derivatives of the handles of the last measure(), times the same roots.
  void differentiate();
  /// A column per component of a joint's turn in its parent's frame.
  /// @param joint  index in active().
  [[nodiscard]] const Mat3d& derivative(std::size_t target, std::size_t joint) const {
    return derivatives_[target * active_.size() + joint];
  }
  /// Model space from the frame of a joint's parent, after differentiate().
  [[nodiscard]] const Mat3d& model_from_parent(std::uint32_t node) const {
    return nodes_[node].model_from_parent;
  }
  /// Whether no turn could bring the only handle nearer: the joints are in a line with it, and the
  /// target is beyond.
  [[nodiscard]] bool is_stretched() const;

 private:
  struct Node {
    std::uint32_t bone = 0;
    std::uint32_t parent = kNone;  ///< A node.
    std::uint32_t joint = kNone;   ///< In joints_.
    std::uint32_t place = kNone;   ///< In active_.
    Vec3d translation, scale;
    Quatd rotation;
    Mat3d matrix;  ///< Of the rotation.
    Mat3d model_from_parent;
  };
  struct Target {
    Vec3d place;
    double root_of_weight = 1.0;
    const PullHandle* handle = nullptr;
  };

  void collect(std::span<const PullTarget> targets);
  void differentiate(std::size_t target, const PullHandle::Part& part);
  [[nodiscard]] Vec3d lifted(const Node& node, const Vec3d& point) const;

  std::vector<std::uint32_t> parents_;
  std::vector<PullJoint> joints_;
  std::vector<std::uint32_t> joint_of_bone_, node_of_bone_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> bones_, active_;
  std::vector<Target> targets_;
  std::vector<Vec3d> errors_;
  std::vector<Mat3d> derivatives_;
};

}  // namespace sunder::animation
