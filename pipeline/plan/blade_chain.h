#pragma once

#include <sunder/plan/plan.h>
#include <sunder/robot/robot.h>

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace sunder::plan {

/// Numbers of the values that move the blade.
using Values = Eigen::VectorXd;
/// The change of a place per change of each of these values.
using PlaceRates = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Where the blade is, in the space of PlanTool::world_from_root.
struct BladePlace {
  Vec3d base = Vec3d::Zero(), tip = Vec3d::Zero();
  PlaceRates base_rates, tip_rates;
};

/// The joints between the root of a robot and the blade. Not thread-safe: it keeps the frames.
class BladeChain {
 public:
  /// @return the first fault of validate_robot(); index_out_of_range for the link;
  ///         invalid_argument for the blade, or if no joint moves it; non_finite_value;
  ///         unsupported_feature for a floating joint.
  static Result<BladeChain> create(const PlanTool& tool);

  /// Number of values that move the blade.
  [[nodiscard]] std::size_t size() const { return moved_.size(); }
  /// Its index in Robot::values. Ascending.
  [[nodiscard]] std::uint32_t value(std::size_t i) const { return moved_[i]; }
  [[nodiscard]] const RobotValue& description(std::size_t i) const {
    return robot_.values[moved_[i]];
  }
  /// Of the joint that has this value; 0: no limit. A chain of mimic joints may be stricter.
  [[nodiscard]] double speed_limit(std::size_t i) const { return speed_limits_[i]; }
  [[nodiscard]] Values rest() const;
  [[nodiscard]] double blade_length() const { return (blade_.base - blade_.tip).norm(); }
  /// The frames of all links at the last place.
  [[nodiscard]] std::span<const Affine3d> frames() const { return frames_; }
  void move_root(const Vec3d& by) { world_from_root_.translation() += by; }

  void place(std::span<const double> values, BladePlace& place, bool with_rates);
  /// Rates of a place that is fixed to a link, after place().
  [[nodiscard]] PlaceRates rates_of(std::uint32_t link, const Vec3d& at) const;

 private:
  BladeChain(const PlanTool& tool, RobotKinematics kinematics);
  Status find_values();
  void find_speed_limits();
  void add_rates(const RobotJoint& joint, std::uint32_t parent, const Vec3d& at,
                 PlaceRates& rates) const;

  Robot robot_;
  MountedBlade blade_;
  Affine3d world_from_root_;
  RobotKinematics kinematics_;
  std::vector<std::uint32_t> moved_;
  std::vector<std::uint32_t> place_of_value_;  ///< In `moved_`, per value of the robot; kNone.
  std::vector<double> speed_limits_;
  std::vector<double> values_;  ///< Of the whole robot.
  std::vector<Affine3d> frames_;
};

}  // namespace sunder::plan
