#pragma once

#include <sunder/robot/robot.h>
#include <sunder/robot/trajectory.h>

#include <functional>
#include <optional>
#include <vector>

#include "bench/plan/link_depth.h"
#include "bench/plan/link_gaps.h"
#include "bench/plan/plan_cases.h"
#include "pipeline/plan/target_path.h"
#include "support/machine/random.h"

namespace sunder::bench {

/// Whether an arm can follow a curve, on the way to it and back too, with its links outside of the
/// rig and of one another, by random walks through the layers of what is free at each time. It
/// shares no code with plans: rates are differences, links are kept away by LinkDepth and LinkGaps.
class MotionSearch {
 public:
  /// @param links  of the same case.
  MotionSearch(const PlanCase& of, double tolerance, LinkDepth& links);

  /// @param samples  at even times.
  /// @param is_good  judges a motion that follows the cut within limits, speeds and tolerance, and
  ///                 on which links are free at all samples.
  /// @return whether it takes one of those that are found.
  bool find(const std::vector<plan::TargetSample>& samples,
            const std::function<bool(const RobotTrajectory&)>& is_good);

 private:
  using Numbers = std::vector<double>;
  struct Bounds {
    Numbers lower, upper;
  };
  /// Values that are free at a time, and how much room they have.
  struct Free {
    Numbers values;
    double room = 0, cost = 0;
    int before = -1;  ///< In the layer before.
  };

  void find_moved();
  [[nodiscard]] Numbers random_values();
  /// Moves values to the nearest ones that reach a sample. @return whether they do.
  struct Aim {
    double depth_share = 0;  ///< Of the wanted depth: how much it may differ.
    double enough = 0.5;     ///< Tolerances.
    bool is_pulled = false;  ///< Towards the wanted direction.
  };
  bool reach(const plan::TargetSample& sample, const Bounds& bounds, const Aim& aim,
             Numbers& values);
  /// Beside the curve (three), deeper or higher than is allowed (one), in tolerances; off the
  /// wanted direction (three).
  using Errors = Eigen::Matrix<double, 7, 1>;
  [[nodiscard]] Errors errors_at(const plan::TargetSample& sample, const Numbers& values,
                                 double depth_share);
  /// The cost of a step: it grows with its speed and with the lean of the blade.
  double cost_of(const plan::TargetSample& sample, const Numbers& from, const Numbers& to,
                 double seconds);
  /// @return empty if a link is inside of the rig or of another one; otherwise the room that is
  ///         left, 0 to 2.
  std::optional<double> room_at(const plan::TargetSample& sample, const Numbers& values);
  /// The walk from values at a sample to the last one.
  std::vector<Numbers> walk(const std::vector<plan::TargetSample>& samples, const Numbers& from);
  /// The motion through values at some samples, and the others between them.
  /// @param depth_share  how much these may differ from the wanted depth.
  RobotTrajectory motion_through(const std::vector<plan::TargetSample>& samples,
                                 const std::vector<Numbers>& values, double depth_share);
  /// Whether a motion keeps speeds between samples that were walked, and links are free at all.
  [[nodiscard]] bool is_free(const std::vector<plan::TargetSample>& samples,
                             const RobotTrajectory& motion);
  void add_next(const std::vector<plan::TargetSample>& samples, std::size_t i,
                const std::vector<Free>& layer, std::vector<Free>& next);

  const PlanCase& of_;
  double tolerance_;
  LinkDepth& links_;
  LinkGaps gaps_;
  RobotKinematics kinematics_;
  std::vector<Affine3d> frames_;
  Bounds limits_;
  Numbers speeds_;
  std::vector<std::size_t> moved_;  ///< Values that move the blade; the others rest.
  test::Random random_;
};

}  // namespace sunder::bench
