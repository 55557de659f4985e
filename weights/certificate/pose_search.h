#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "core/internal/ordered.h"
#include "weights/certificate/joint_path.h"

namespace sunder::certificate {

/// The motion of a joint, about its centre, in model space of the bind pose: a rotation after a
/// stretch, which is symmetric.
struct JointMotion {
  Mat3d rotation = Mat3d::Identity();
  Vec3d slide = Vec3d::Zero();
  Mat3d stretch = Mat3d::Identity();

  [[nodiscard]] Mat3d linear() const { return multiply(rotation, stretch); }
};

/// Seeks the joint motions within the limits that make the sum of a point's terms as long, or as
/// short, as possible. Joints from the top upwards stretch evenly as far as they may; all others
/// outside of the path stay as close to bind as their limits allow.
class PoseSearch {
 public:
  enum class Goal : std::uint8_t { longest, shortest };

  PoseSearch(const JointTree::State& tree, std::span<const SkinTerm> terms, Goal goal);

  void start_at_bind();
  /// The best of a few random poses.
  void start_at_random(std::mt19937_64& random);

  /// Replaces the terms' positions. Bones as in the constructor, weights are kept.
  void set_positions(std::span<const SkinTerm> terms);

  /// One pass from the top to the leaves; each joint takes its best motion in closed form, or keeps
  /// its own. @return the length afterwards, without what joints from the top upwards add.
  double improve();
  /// Passes until the length changes by less than 1e-7 of it, at most 60.
  double improve_fully();

  /// model_from_bind of the bones of the skeleton, linear parts and translations.
  [[nodiscard]] std::vector<Affine3d> model_from_bind() const;
  /// The largest change of the length by the joints from the top upwards.
  [[nodiscard]] double growth() const;
  /// The pose, without its value. Motions that do nothing are left out.
  [[nodiscard]] FoundPose pose() const;
  /// The sum of the terms by those matrices; without what unequal sums (rounding) add.
  [[nodiscard]] double measure(std::span<const SkinTerm> terms) const;

 private:
  [[nodiscard]] JointMotion neutral(const PreparedJoint& joint) const;
  [[nodiscard]] JointMotion random_motion(const PreparedJoint& joint,
                                          std::mt19937_64& random) const;
  [[nodiscard]] JointMotion motion_of(std::uint32_t bone) const;
  [[nodiscard]] bool is_from_top_upwards(std::uint32_t node) const;
  [[nodiscard]] Vec3d posed(std::size_t i) const;
  [[nodiscard]] double add_up();
  void slide(std::size_t i, const Mat3d& above, const Vec3d& rest);
  void turn_and_stretch(std::size_t i, const Mat3d& above, const Vec3d& rest);
  void stretch(const PreparedJoint& joint, const Mat3d& above, const Vec3d& rest, const Vec3d& y,
               JointMotion& motion) const;
  void move_joint(std::size_t i);

  const JointTree::State& tree_;
  double sign_ = 1.0;  // -1: shortest
  std::vector<PathJoint> path_;
  std::vector<JointMotion> motions_;  // per joint of the path; the top's is not used
  std::vector<double> m_;             // sums of subtrees
  std::vector<Vec3d> x_;              // sums of subtrees, each seen from its joint
  std::vector<Mat3d> inside_;         // from below a joint to the frame of the top
  Vec3d total_ = Vec3d::Zero();       // the sum of all terms, seen from the top
};

}  // namespace sunder::certificate
