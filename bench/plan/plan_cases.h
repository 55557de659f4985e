#pragma once

#include <sunder/core/character.h>
#include <sunder/plan/plan.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "support/machine/random.h"

namespace sunder::bench {

/// A character that moves, and the size by which arms are scaled to it: 1 for 1.8 m.
struct MovingRig {
  std::string name;
  std::shared_ptr<const Character> character;
  double size = 1;
};

/// Ten rigs: those of the repository, and shared models if they are there.
[[nodiscard]] std::vector<MovingRig> moving_rigs();

/// An arm with a blade; its root is where the robot's file has it.
struct Arm {
  std::string name;
  PlanTool tool;
  std::vector<std::vector<Vec3d>> vertices;  ///< Per link, of its meshes, in its frame.
};

/// The surgical arm, the panda and an arm of six axes; without the shared models, the last alone.
[[nodiscard]] std::vector<Arm> arms();

/// A curve, an arm that reaches its middle, and how it does.
struct PlanCase {
  MovingRig rig;
  std::string arm;
  PlanTool tool;
  std::vector<std::vector<Vec3d>> vertices;  ///< Of the arm, as it is scaled.
  WoundTarget target;
  PlanTiming timing;
  std::vector<double> middle_values;  ///< All values of the robot, in the middle of the motion.
};

/// Seeded by its number. @return empty if the random curve runs off the surface.
[[nodiscard]] std::optional<PlanCase> make_case(const std::vector<MovingRig>& rigs,
                                                const std::vector<Arm>& arms, std::uint64_t seed);

}  // namespace sunder::bench
