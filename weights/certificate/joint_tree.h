#pragma once

#include <sunder/certificate/certificate.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace sunder {
namespace certificate {

/// Choices of s that are tried for all points: the closed form, parts of the way from 1 down to the
/// cosine, 0, and in the last lane for each joint the best one if it alone moved.
inline constexpr int kLanes = 8;
inline constexpr int kZeroLane = kLanes - 2, kFittedLane = kLanes - 1;

/// How far from their common sum two sums of weights may be and count as equal.
inline constexpr double kSumTolerance = 4e-6;
/// The same for sums of doubles that were divided by them.
inline constexpr double kDividedSumTolerance = 1e-12;

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
  double middle_cosine = 1.0, middle_sine = 0.0;  ///< Of middle().
  double half_cosine = 1.0, half_sine = 0.0;      ///< Of half_range(), at most 180 degrees.
  double squared_chord = 0.0;                     ///< 2 - 2 half_cosine, exact for small angles.
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

  /// The largest distance of a unit vector, turned within the range, from s >= 0 times its middle:
  /// sqrt(s^2 - 2 s cos(half range) + 1), exact for small angles.
  [[nodiscard]] double distance_to_shrunk(double s) const {
    return std::sqrt((1.0 - s) * (1.0 - s) + s * squared_chord);
  }
  /// Sets one lane of a turn about the middle of the range. Any s >= 0 is valid.
  template <int lanes>
  void set_lane(double s, int lane, JointTurn<lanes>& of) const {
    of.cosine[lane] = s * middle_cosine;
    of.sine[lane] = s * middle_sine;
    of.radius[lane] = distance_to_shrunk(s);
  }
};

/// The s with the least bound if this joint alone moves: the place where the straight way from
/// -rest to the end of the turned arm meets the arm's middle.
/// @param arm   from the joint's centre to the sum of what it moves.
/// @param rest  the sum of everything else, seen from the joint's parent.
[[nodiscard]] double best_shrink(const PreparedJoint& joint, const Vec3d& arm, const Vec3d& rest);

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
