#include "pipeline/plan/confirm_causes.h"

#include <algorithm>

namespace sunder::plan {
namespace {

using Kind = PlanObstacle::Kind;

constexpr double kTimesFaster = 10;  ///< What speeds and accelerations are relaxed by.
constexpr int kMostFurtherPlans = 6;

bool is_relaxed(Kind kind) {
  return kind == Kind::collision || kind == Kind::self_collision || kind == Kind::joint_speed ||
         kind == Kind::acceleration;
}

bool is_any_named(const PlanReport& report, const std::function<bool(const PlanObstacle&)>& is_it) {
  return std::any_of(report.obstacles.begin(), report.obstacles.end(), is_it);
}

bool is_same_obstacle(const PlanObstacle& a, const PlanObstacle& b) {
  return a.kind == b.kind && a.value == b.value && a.other == b.other;
}

/// Adds those of `more` whose kind is named. @return whether there were any.
bool add_new(const PlanReport& more, PlanReport& report) {
  std::vector<PlanObstacle> added;
  for (const PlanObstacle& obstacle : more.obstacles) {
    const bool is_kind = is_any_named(
        report, [&](const PlanObstacle& known) { return known.kind == obstacle.kind; });
    const bool is_known = is_any_named(
        report, [&](const PlanObstacle& known) { return is_same_obstacle(known, obstacle); });
    if (is_kind && !is_known && is_relaxed(obstacle.kind)) added.push_back(obstacle);
  }
  report.obstacles.insert(report.obstacles.end(), added.begin(), added.end());
  return !added.empty();
}

}  // namespace

FreedInputs freed_inputs(const PlanTool& tool, const PlanOptions& options,
                         const PlanReport& report) {
  FreedInputs freed{tool, options};
  Robot& robot = freed.tool.robot;
  std::erase_if(freed.tool.shapes, [&](const BoneCollider& shape) {
    const std::string& link = robot.links[shape.bone].name;
    return is_any_named(report, [&](const PlanObstacle& obstacle) {
      return (obstacle.kind == Kind::collision || obstacle.kind == Kind::self_collision) &&
             obstacle.value == link;
    });
  });
  for (const RobotValue& value : robot.values)
    if (is_any_named(report, [&](const PlanObstacle& obstacle) {
          return obstacle.kind == Kind::joint_speed && obstacle.value == value.name;
        }))
      robot.joints[value.joint].velocity *= kTimesFaster;
  if (is_any_named(
          report, [](const PlanObstacle& obstacle) { return obstacle.kind == Kind::acceleration; }))
    freed.options.maximum_acceleration *= kTimesFaster;
  return freed;
}

Status confirm_causes(const PlanTool& tool, const PlanOptions& options,
                      const std::function<Result<PlannedMotion>(const FreedInputs&)>& plan,
                      PlanReport& report) {
  for (int round = 0; round < kMostFurtherPlans; ++round) {
    if (report.obstacles.empty() || !is_relaxed(report.obstacles.front().kind)) return {};
    const Result<PlannedMotion> further = plan(freed_inputs(tool, options, report));
    if (!further) return further.error();
    if (further->report.is_reachable || !add_new(further->report, report)) return {};
  }
  return {};
}

}  // namespace sunder::plan
