#pragma once

#include <sunder/plan/plan.h>

#include <memory>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/blade_errors.h"
#include "pipeline/plan/inverse_kinematics.h"
#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// Diagonal of the box around all vertices in a pose, metres.
[[nodiscard]] double diagonal_of(const Character& character, const ModelPose& pose);

/// What PlanOptions::tolerance of 0 stands for, metres.
[[nodiscard]] double usual_tolerance(const Character& character, const TargetPath& path,
                                     const ModelPose& pose);

/// The parts that every search for a motion uses, made from its inputs.
struct PlanSetup {
  BladeChain chain;
  TargetPath path;
  double tolerance = 0;  ///< Metres.
  ErrorScales scales;
  SplineLimits limits;

  /// @return the failures of plan_motion() but for those of the timing.
  static Result<PlanSetup> create(const std::shared_ptr<const Character>& character,
                                  const WoundTarget& target, const PlanTiming& timing,
                                  const PlanTool& tool, const PlanOptions& options);
};

}  // namespace sunder::plan
