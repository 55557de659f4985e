#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>
#include <sunder/core/skeleton.h>
#include <sunder/core/status.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sunder {

// Robots as trees of links and joints, and their forward kinematics. Conventions: docs/robot.md.

/// How a joint moves its link, and the values that it takes.
enum class RobotJointType : std::uint8_t {
  fixed,       ///< No value.
  revolute,    ///< One: radians about the axis, within limits.
  continuous,  ///< One: radians about the axis, without limits.
  prismatic,   ///< One: metres along the axis, within limits.
  planar,      ///< Three: metres along two axes of the plane, radians about its normal (`axis`).
  floating,    ///< Seven: position, metres, then a quaternion x y z w of any length; zero: no turn.
};

/// Number of values of a joint of this type that mimics no other.
[[nodiscard]] constexpr std::uint32_t value_count_of(RobotJointType type) {
  switch (type) {
    case RobotJointType::fixed: return 0;
    case RobotJointType::revolute:
    case RobotJointType::continuous:
    case RobotJointType::prismatic: return 1;
    case RobotJointType::planar: return 3;
    case RobotJointType::floating: return 7;
  }
  return 0;
}

/// The joint that connects a link to its parent:
/// parent_from_link = parent_from_joint * motion(type, axis, value).
struct RobotJoint {
  std::string name;
  RobotJointType type = RobotJointType::fixed;
  Affine3d parent_from_joint = Affine3d::Identity();  ///< Rotation and translation.
  Vec3d axis = Vec3d(1.0, 0.0, 0.0);                  ///< In the joint's frame; unit length.
  /// In Robot::values: the first of the joint's own values, or the value that drives it if it
  /// mimics another joint, which may mimic a further one. kNone: it does not move.
  std::uint32_t first_value = kNone;
  /// The joint that it mimics, as the file says; kNone: none.
  std::uint32_t mimicked_joint = kNone;
  /// Position of the joint = multiplier * values[first_value] + offset, all steps of a chain of
  /// mimic joints taken together. 1 and 0 if it mimics none. Without a value: its offset.
  double multiplier = 1.0, offset = 0.0;
  /// As the file says, of revolute and prismatic joints; without limits -infinity and infinity.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double velocity = 0.0;  ///< Largest, rad/s or m/s; 0: the file has none.
  double effort = 0.0;    ///< Largest, N m or N; 0: the file has none.
};

struct RobotLink {
  std::string name;
  std::uint32_t parent = kNone;  ///< Smaller than the link's own index; kNone for link 0 only.
};

/// One of the numbers that pose a robot.
struct RobotValue {
  std::string name;         ///< The joint's; "base.x", "base.qw" if the joint has several values.
  std::uint32_t joint = 0;  ///< In Robot::joints.
  /// -infinity and infinity if there are no limits.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double rest = 0.0;  ///< 0, or the limit nearest to it; 1 for the w of a floating joint.
};

/// A tree of links. Plain data; load_robot() fills it from a URDF file, and a program can fill it
/// too.
struct Robot {
  std::string name;
  /// Parents before children, depth first, children in the order of the file. Link 0 is the root.
  std::vector<RobotLink> links;
  /// joints[i] moves links[i + 1]; one less than there are links.
  std::vector<RobotJoint> joints;
  std::vector<RobotValue> values;  ///< In the order of the joints that have values of their own.
};

/// Checks what the functions below rely on: sizes, parents, indices, names that are unique, axes of
/// unit length, rotations, finite numbers, limits in order. O(size), allocates.
/// @return size_mismatch, not_a_tree, index_out_of_range, non_finite_value or invalid_argument
/// with the link, joint or value.
[[nodiscard]] SUNDER_API Status validate_robot(const Robot& robot);

/// Index of the link, joint or value of that name; kNone if there is none. O(size).
[[nodiscard]] SUNDER_API std::uint32_t find_link(const Robot& robot, std::string_view name);
[[nodiscard]] SUNDER_API std::uint32_t find_joint(const Robot& robot, std::string_view name);
[[nodiscard]] SUNDER_API std::uint32_t find_value(const Robot& robot, std::string_view name);

/// RobotValue::rest of all values: the pose in which the robot's character is at rest. Allocates;
/// none if there is no memory.
[[nodiscard]] SUNDER_API std::vector<double> rest_values(const Robot& robot);

/// Enforces limits: moves every value that is outside of its limits to the nearest one.
/// @param values  one per Robot::values. NaN stays.
/// @return the number of values that changed; size_mismatch. Does not allocate.
[[nodiscard]] SUNDER_API Result<std::uint32_t> clamp_to_limits(const Robot& robot,
                                                               std::span<double> values);

/// Reports limits: the first value that is outside of its limits by more than `tolerance`.
/// @return size_mismatch; non_finite_value or invalid_argument with the value, and in the text its
/// name, number and limits. Does not allocate.
[[nodiscard]] SUNDER_API Status check_limits(const Robot& robot, std::span<const double> values,
                                             double tolerance = 1e-9);

/// Forward kinematics of a robot, prepared once. Immutable; copies share their state.
class SUNDER_API RobotKinematics {
 public:
  /// @return the first fault of validate_robot(); limit_exceeded: out of memory.
  [[nodiscard]] static Result<RobotKinematics> create(const Robot& robot);

  [[nodiscard]] std::uint32_t link_count() const;
  [[nodiscard]] std::uint32_t value_count() const;

  /// Poses all links. Values are taken as they are, outside of their limits too; see
  /// clamp_to_limits() and check_limits(). O(links); does not allocate; thread-safe.
  ///
  /// @param values  one per Robot::values: radians, metres.
  /// @param model_from_link  one per link, written: the pose of the link's frame.
  /// @param model_from_root  the pose of link 0.
  /// @return size_mismatch, or non_finite_value with the first such value. Nothing is written then.
  [[nodiscard]] Status evaluate(std::span<const double> values, std::span<Affine3d> model_from_link,
                                const Affine3d& model_from_root = Affine3d::Identity()) const;

  struct State;  ///< For the library alone.

 private:
  explicit RobotKinematics(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

/// The pose of the character that load_robot() makes, whose bones are the links: each link relative
/// to its parent, in single precision. Allocates only what the pose lacks.
/// @param model_from_link  one per link, from RobotKinematics::evaluate(): rotations and
/// translations.
/// @return size_mismatch.
[[nodiscard]] SUNDER_API Status pose_of_links(const Robot& robot,
                                              std::span<const Affine3d> model_from_link,
                                              Pose& pose);

}  // namespace sunder
