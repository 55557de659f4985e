#pragma once

#include <sunder/core/character.h>
#include <sunder/plan/plan.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// A place of the character's surface that a link comes near.
struct NearPlace {
  double time = 0;
  std::size_t shape = 0;  ///< In PlanTool::shapes.
  Vec3d place = Vec3d::Zero();
  double distance = 0;  ///< Below 0: inside the shape.
  /// Of the surface, if the middle of the shape is below it; otherwise zero.
  Vec3d normal = Vec3d::Zero();
};

/// The distance of a robot's links from a character that moves.
class Clearance {
 public:
  /// @param character, tool  kept by reference.
  static Result<Clearance> create(const Character& character, const PlanTool& tool,
                                  const PlanTiming& timing, std::span<const TargetSample> samples);

  [[nodiscard]] bool is_needed() const { return !shapes_.empty(); }

  /// Per instant and link the nearest place, if it is nearer than `margin`.
  /// @param values_at  of the joints that move the blade, at a time.
  [[nodiscard]] std::vector<NearPlace> find(BladeChain& chain,
                                            const std::function<Values(double)>& values_at,
                                            double margin) const;

 private:
  struct Instant {
    double time;
    std::vector<Vec3d> places, normals;
  };

  explicit Clearance(const PlanTool& tool) : tool_(&tool) {}

  const PlanTool* tool_;
  std::vector<std::size_t> shapes_;  ///< Those that count.
  std::vector<Instant> instants_;
};

}  // namespace sunder::plan
