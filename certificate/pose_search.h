#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "certificate/joint_path.h"

namespace sunder::certificate {

/// The motion of a joint, about its centre, in model space of the bind pose.
struct JointMotion {
  Mat3d rotation = Mat3d::Identity();
  Vec3d slide = Vec3d::Zero();
  double scale = 1.0;
};

/// Seeks the joint motions within the limits that make the sum of a point's terms as long, or as
/// short, as possible. All joints outside of the path stay as close to bind as their limits allow.
class PoseSearch {
 public:
  enum class Goal : std::uint8_t { longest, shortest };

  PoseSearch(const JointTree::State& tree, std::span<const SkinTerm> terms, Goal goal);

  void start_at_bind();
  void start_at_random(std::mt19937_64& random);

  /// Replaces the terms' positions. Bones as in the constructor, weights are kept.
  void set_positions(std::span<const SkinTerm> terms);

  /// One pass from the top to the leaves; each joint takes its best motion in closed form.
  /// @return the length afterwards.
  double improve();
  /// Passes until the length changes by less than 1e-7 of it, at most 60.
  double improve_fully();

  /// model_from_bind of the bones of the skeleton, linear parts and translations.
  [[nodiscard]] std::vector<Affine3d> model_from_bind() const;
  /// The pose, without its value. Motions that do nothing are left out.
  [[nodiscard]] FoundPose pose() const;
  /// The sum of the terms by those matrices; without what unequal sums (rounding) add.
  [[nodiscard]] double measure(std::span<const SkinTerm> terms) const;

 private:
  [[nodiscard]] JointMotion neutral(const PreparedJoint& joint) const;
  [[nodiscard]] Vec3d posed(std::size_t i) const;
  void add_up();
  void turn(std::size_t i, const Vec3d& rest);
  void slide(std::size_t i, const Vec3d& rest);
  void stretch(std::size_t i, const Vec3d& rest);
  void move_joint(std::size_t i);

  const JointTree::State& tree_;
  double sign_ = 1.0;  // -1: shortest
  std::vector<PathJoint> path_;
  std::vector<JointMotion> motions_;  // per joint of the path; the top's is not used
  std::vector<double> m_;             // sums of subtrees
  std::vector<Vec3d> x_;              // sums of subtrees, each seen from its joint
  std::vector<Vec3d> rest_;           // what the other terms add to it, seen from there
};

}  // namespace sunder::certificate
