#pragma once

#include <sunder/plan/plan.h>
#include <sunder/robot/robot.h>

#include <vector>

#include "pipeline/plan/target_path.h"

namespace sunder::bench {

/// Whether an arm reaches samples, by a search that shares no code with plans: Hooke and Jeeves'
/// pattern search (1961) over the values of the robot, with RobotKinematics alone.
class PatternSearch {
 public:
  PatternSearch(const PlanTool& tool, double tolerance);

  /// Values within bounds that reach a sample, near `values`. @return whether they do.
  bool reach(const plan::TargetSample& sample, const std::vector<double>& lower,
             const std::vector<double>& upper, std::vector<double>& values) const;

  /// The same from `starts` random starts.
  bool reach_from_anywhere(const plan::TargetSample& sample, const std::vector<double>& lower,
                           const std::vector<double>& upper, int starts) const;

 private:
  [[nodiscard]] double cost(const plan::TargetSample& sample,
                            const std::vector<double>& values) const;

  const PlanTool& tool_;
  RobotKinematics kinematics_;
  double tolerance_;
  mutable std::vector<Affine3d> frames_;
};

}  // namespace sunder::bench
