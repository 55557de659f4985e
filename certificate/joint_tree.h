#pragma once

#include <sunder/certificate/certificate.h>

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace sunder {
namespace certificate {

/// Numbers of parts of the way (of s from 1 down to the cosine) that are tried for all points.
inline constexpr int kLanes = 6;

/// How far from their common sum two sums of weights may be and count as equal.
inline constexpr double kSumTolerance = 4e-6;

template <int lanes>
using Lanes = Eigen::Array<double, lanes, 1>;

/// How a ball crosses a joint: y goes to along * s * y, and y across the axis to
/// cosine * y + sine * (axis x y), both known up to `radius` * |y|. One entry per lane.
template <int lanes>
struct JointTurn {
  Lanes<lanes> cosine, sine, radius;
};

/// A joint with its range, in model space of the bind pose.
struct PreparedJoint {
  std::uint32_t parent = 0;  ///< Node of the closest ancestor that moves; 0: the virtual root.
  bool is_hinge = false;
  bool has_slide_range = true, has_scale_range = true;
  Vec3d centre = Vec3d::Zero();
  Vec3d axis = Vec3d::UnitX();         ///< Hinge.
  Vec3d slide = Vec3d::Zero();         ///< Middle of the segment.
  Vec3d half_segment = Vec3d::Zero();  ///< From the middle to its end.
  double slide_radius = 0.0;           ///< Around the segment.
  double slide_reach = 0.0;            ///< Around the middle.
  double lower = 0.0, upper = 0.0;     ///< Ball: 0 and the angle. Radians.
  double scale_lower = 1.0, scale_upper = 1.0;
  JointTurn<kLanes> turn;
  double growth_above = 1.0;            ///< Product of largest scales from the root to this joint.
  double shrink_above = 1.0;            ///< Product of smallest scales.
  std::uint32_t unscaled_bone = kNone;  ///< Bone without a scale range on that way.
  double largest_turn = 0.0;            ///< From bind, radians.
  double strain = 0.0;                  ///< log(1 + largest relative change of a length).

  [[nodiscard]] double scale() const { return 0.5 * (scale_lower + scale_upper); }
  [[nodiscard]] double scale_half() const { return 0.5 * (scale_upper - scale_lower); }
  [[nodiscard]] double middle() const { return is_hinge ? 0.5 * (lower + upper) : 0.0; }
  [[nodiscard]] double half_range() const { return is_hinge ? 0.5 * (upper - lower) : upper; }
};

/// The largest distance of a rotated unit vector from s times its middle, for rotations of up to
/// `angle`: sqrt(s^2 - 2 s cos(angle) + 1), stable for small angles. s >= 0.
[[nodiscard]] double distance_to_shrunk(double s, double angle);

}  // namespace certificate

/// Nodes: 0 is the virtual root, bone + 1 the bone. Bones that cannot move are merged with the
/// closest ancestor that can.
struct JointTree::State {
  std::vector<certificate::PreparedJoint> nodes;
  std::vector<std::uint32_t> node_of_bone;
  std::vector<std::uint32_t> parents;  ///< Of the skeleton's bones.
  ModelPose bind;
  double extent = 0.0;  ///< Largest distance of a centre from the origin.
};

}  // namespace sunder
