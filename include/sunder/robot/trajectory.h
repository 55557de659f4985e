#pragma once

#include <sunder/operation/operation.h>
#include <sunder/robot/robot.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sunder {

// The motion of a robot over time, and the strokes that a blade on one of its links makes.

/// Values of a robot at some times; between two times each value changes evenly.
/// load_trajectory() of <sunder/io/trajectory_file.h> reads one.
struct RobotTrajectory {
  std::vector<std::string> names;  ///< RobotValue::name; values of other names stay at rest.
  std::vector<double> times;       ///< Seconds, increasing; at least one.
  std::vector<double> values;      ///< times x names, one time after the other: radians, metres.
};

/// A value that leaves the limits of its joint during a motion, where it is farthest outside.
struct LimitExcess {
  std::uint32_t value = 0;  ///< In Robot::values.
  double time = 0.0;        ///< Seconds.
  double number = 0.0;      ///< What the trajectory says; radians or metres.
};

struct RobotMotionOptions {
  bool clamps_to_limits = false;  ///< Values outside of their limits are moved to the nearest one.
};

/// A robot that follows a trajectory. Immutable; copies share their state.
class SUNDER_API RobotMotion {
 public:
  /// @return the first fault of validate_robot(); empty_input without a time; size_mismatch;
  ///         non_finite_value or invalid_argument with the time; not_found for a name, with the
  ///         nearest ones; limit_exceeded, out of memory. O(size of both), allocates.
  [[nodiscard]] static Result<RobotMotion> create(const Robot& robot,
                                                  const RobotTrajectory& trajectory,
                                                  const RobotMotionOptions& options = {});

  [[nodiscard]] double first_time() const;  ///< Seconds.
  [[nodiscard]] double last_time() const;
  /// The times of the trajectory.
  [[nodiscard]] std::span<const double> times() const;
  [[nodiscard]] std::uint32_t link_count() const;
  [[nodiscard]] std::uint32_t value_count() const;

  /// The values that leave their limits, also if they are clamped; ascending, each once.
  [[nodiscard]] std::span<const LimitExcess> excesses() const;

  /// The values at a time; before the first and after the last time they are held.
  /// @param values  one per Robot::values, written.
  /// @return size_mismatch, non_finite_value. O(values + log times); does not allocate.
  Status values_at(double time, std::span<double> values) const;

  /// The frames of all links at a time. @param model_from_link  as RobotKinematics::evaluate().
  /// @return as values_at() and evaluate(); limit_exceeded, out of memory. O(links), allocates.
  Status pose_at(double time, std::span<Affine3d> model_from_link,
                 const Affine3d& model_from_root = Affine3d::Identity()) const;

 private:
  struct State;
  explicit RobotMotion(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

/// A straight cutting edge that is fixed to a link. The link's frame, metres.
struct MountedBlade {
  std::uint32_t link = 0;
  Vec3d base = Vec3d::Zero(), tip = Vec3d::Zero();  ///< As Blade; not at one place.
};

struct SweepOptions {
  /// Largest distance that base or tip moves from one blade to the next, metres; > 0.
  double spacing = 0.002;
  /// Largest time between two blades, seconds; > 0. For characters that move meanwhile.
  double seconds = std::numeric_limits<double>::infinity();
  /// The part of the motion that is swept, seconds; clamped to the trajectory.
  double first_time = -std::numeric_limits<double>::infinity();
  double last_time = std::numeric_limits<double>::infinity();
  std::uint32_t maximum_blades = 100'000;
};

/// The positions of a blade, where it moved, and when it was there.
struct BladeSweep {
  Stroke blades;              ///< In the space of `world_from_root`.
  std::vector<double> times;  ///< Seconds, one per blade, increasing.
};

/// Samples the motion of a blade by the distance that it moves: steps are halved until base and tip
/// move by at most `spacing`, and no joint turns by more than 0.1 rad. While it stands still there
/// are no blades, unless `seconds` asks for them.
///
/// @param world_from_root  places link 0 of the robot, in the space in which the character stands.
/// @return index_out_of_range for the link; invalid_argument for the blade or an option;
///         empty_input for a blade that does not move; limit_exceeded for more than
///         `maximum_blades`, or out of memory. O(blades x links), allocates. Reentrant.
[[nodiscard]] SUNDER_API Result<BladeSweep> sweep_blade(const RobotMotion& motion,
                                                        const MountedBlade& blade,
                                                        const Affine3d& world_from_root,
                                                        const SweepOptions& options = {});

/// The tear that a sweep makes in a character whose model space is the space of the sweep.
///
/// @param pose   of the character at the first blade.
/// @param speed  >= 0. 0: the character keeps that pose. Otherwise `pose` is a ClipPose, and the
///               clip runs on by this many seconds per second of the sweep; a change of the pose
///               per blade.
/// @return invalid_argument; empty_input for fewer than two blades; limit_exceeded, out of memory.
[[nodiscard]] SUNDER_API Result<TearOperation> tear_of_sweep(const BladeSweep& sweep,
                                                             const PoseSpec& pose = RestPose{},
                                                             double speed = 0.0,
                                                             const TearOptions& options = {});

}  // namespace sunder
