// Plans of 100 random curves on ten rigs that move, by three arms, beside inverse kinematics for
// each frame and a search that shares no code. bench_plan [--cases N] [--first SEED] [--summary].
// Prints the figures of docs/plan.md.

#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/cpu_seconds.h"
#include "bench/harness/json_object.h"
#include "bench/plan/frame_ik.h"
#include "bench/plan/link_depth.h"
#include "bench/plan/link_gaps.h"
#include "bench/plan/motion_search.h"
#include "bench/plan/pattern_search.h"
#include "bench/plan/plan_cases.h"
#include "pipeline/plan/measure_wound.h"
#include "pipeline/plan/target_path.h"
#include "support/models/rigs.h"

namespace {

using namespace sunder;
using namespace sunder::bench;

constexpr double kFrames = 30;  ///< Samples per second of the inverse kinematics per frame.

struct Figures {
  int cases = 0, reachable = 0, reached = 0, planned = 0, hausdorff_ok = 0, repeated = 0, same = 0,
      over_limits = 0, penetrations = 0, overlaps = 0, causes = 0, causes_true = 0;
  std::vector<double> seconds, hausdorff, frame_hausdorff, place, depth, angle;
};

double median(std::vector<double> of) {
  if (of.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(of.begin(), of.end());
  return of[of.size() / 2];
}

/// Whether a trajectory leaves limits or speeds, between its times too.
bool leaves_limits(const PlanTool& tool, const RobotTrajectory& trajectory) {
  const auto motion = RobotMotion::create(tool.robot, trajectory);
  if (!motion || !motion->excesses().empty()) return true;
  std::vector<double> values(tool.robot.values.size()), before;
  constexpr int kTimes = 4000;
  const double step = motion->last_time() / kTimes;
  for (int i = 0; i <= kTimes; ++i) {
    if (!motion->values_at(i * step, values)) return true;
    if (!check_limits(tool.robot, values)) return true;
    for (std::size_t v = 0; v < values.size() && i > 0; ++v) {
      const double limit = tool.robot.joints[tool.robot.values[v].joint].velocity;
      if (limit > 0 && std::abs(values[v] - before[v]) > step * limit * (1 + 1e-6)) return true;
    }
    before = values;
  }
  return false;
}

/// At 200 times: how deep a vertex of a link other than the blade's comes below the surface, and
/// the least gap of links that have to keep apart, at most the size of the rig.
struct LinkPlaces {
  double deepest = 0, least_gap = 0;
};
LinkPlaces look_at_links(const PlanCase& of, const RobotTrajectory& trajectory) {
  const auto motion = RobotMotion::create(of.tool.robot, trajectory);
  LinkDepth links(of);
  const LinkGaps gaps(of.tool);
  std::vector<Affine3d> frames(of.tool.robot.links.size());
  LinkPlaces found{0, of.rig.size};
  constexpr int kTimes = 200;
  for (int i = 0; i <= kTimes; ++i) {
    const double time = motion->last_time() * i / kTimes;
    if (!motion->pose_at(time, frames, of.tool.world_from_root))
      return {std::numeric_limits<double>::infinity(), 0};
    found.deepest = std::max(found.deepest, links.deepest_vertex(time, frames));
    found.least_gap = gaps.least(frames, found.least_gap);
  }
  return found;
}

/// The largest distance of lips and curve after inverse kinematics for each frame.
double frame_hausdorff(const PlanCase& of, const plan::TargetPath& path, const PlanReport& report) {
  const double end = of.timing.approach + of.timing.cut + of.timing.retreat;
  const auto samples = plan::sample_target(*of.rig.character, path, of.timing,
                                           static_cast<std::uint32_t>(std::ceil(end * kFrames)));
  const RobotTrajectory trajectory = frame_ik(of.tool, *samples, of.middle_values);
  const auto motion = RobotMotion::create(of.tool.robot, trajectory);
  SweepOptions options;
  options.seconds = 1.0 / 60;
  const auto sweep = sweep_blade(*motion, of.tool.blade, of.tool.world_from_root, options);
  if (!sweep) return std::numeric_limits<double>::infinity();
  const auto tear = tear_of_sweep(*sweep, of.timing.pose, of.timing.clip_speed);
  const auto pose = plan::pose_at(*of.rig.character, of.timing, report.cut_begins);
  const auto measured = plan::measure_wound(of.rig.character, path, *tear, *pose);
  return measured ? measured->hausdorff : std::numeric_limits<double>::infinity();
}

/// Whether a motion tears along the curve.
bool makes_wound(const PlanCase& of, const RobotTrajectory& trajectory,
                 const plan::TargetPath& path, double tolerance) {
  const auto motion = RobotMotion::create(of.tool.robot, trajectory);
  if (!motion) return false;
  SweepOptions options;
  options.spacing = 0.002 * of.rig.size;
  options.seconds = 1.0 / 60;
  const auto sweep = sweep_blade(*motion, of.tool.blade, of.tool.world_from_root, options);
  if (!sweep) return false;
  const auto tear = tear_of_sweep(*sweep, of.timing.pose, of.timing.clip_speed);
  const auto pose = plan::pose_at(*of.rig.character, of.timing, of.timing.approach);
  if (!tear || tear->stroke.empty() || !pose) return false;
  const auto measured = plan::measure_wound(of.rig.character, path, *tear, *pose);
  return measured && measured->hausdorff <= tolerance;
}

bool is_named(const PlanReport& report, PlanObstacle::Kind kind, const std::string& name) {
  return std::any_of(
      report.obstacles.begin(), report.obstacles.end(),
      [&](const PlanObstacle& named) { return named.kind == kind && named.value == name; });
}

/// Whether a further plan, without the links and the limits of speed that are named, makes the
/// curve or meets an obstacle of a kind that was not named.
bool gets_farther(const PlanCase& of, const PlanOptions& options, const PlanReport& report) {
  using Kind = PlanObstacle::Kind;
  PlanTool freed = of.tool;
  std::erase_if(freed.shapes, [&](const BoneCollider& shape) {
    const std::string& link = freed.robot.links[shape.bone].name;
    return is_named(report, Kind::collision, link) || is_named(report, Kind::self_collision, link);
  });
  for (const RobotValue& value : freed.robot.values)
    if (is_named(report, Kind::joint_speed, value.name))
      freed.robot.joints[value.joint].velocity *= 10;
  const auto again = plan_motion(of.rig.character, of.target, of.timing, freed, options);
  if (!again) return false;
  if (again->report.is_reachable) return true;
  const Kind next = again->report.obstacles.front().kind;
  return std::none_of(report.obstacles.begin(), report.obstacles.end(),
                      [&](const PlanObstacle& named) { return named.kind == next; });
}

/// Whether a search that shares no code reaches the place that is named without the limits that
/// are named, or for `reach` without any limit.
bool is_reached_without(const PlanCase& of, double tolerance, const PlanReport& report,
                        const std::vector<plan::TargetSample>& samples) {
  const PlanObstacle& first = report.obstacles.front();
  std::vector<double> lower, upper;
  for (const RobotValue& value : of.tool.robot.values) {
    const bool is_free = first.kind == PlanObstacle::Kind::reach ||
                         is_named(report, PlanObstacle::Kind::joint_limit, value.name);
    const double more = is_free ? 2 * std::min(value.upper - value.lower, 6.4) : 0;
    lower.push_back(value.lower - more);
    upper.push_back(value.upper + more);
  }
  const auto away = [&](const plan::TargetSample& sample) {
    return std::abs(sample.share - first.at) + (sample.depth > 0 ? 0 : 10);
  };
  const auto nearest = std::min_element(
      samples.begin(), samples.end(),
      [&](const plan::TargetSample& a, const plan::TargetSample& b) { return away(a) < away(b); });
  return PatternSearch(of.tool, tolerance).reach_from_anywhere(*nearest, lower, upper, 60);
}

/// Whether the obstacles that a plan names are what stops it.
bool are_true(const PlanCase& of, const PlanOptions& options, const PlannedMotion& planned,
              const plan::TargetPath& path, const std::vector<plan::TargetSample>& samples) {
  const PlanReport& report = planned.report;
  switch (report.obstacles.front().kind) {
    case PlanObstacle::Kind::wound:
      return !leaves_limits(of.tool, planned.trajectory) &&
             !makes_wound(of, planned.trajectory, path, options.tolerance);
    case PlanObstacle::Kind::joint_limit:
      return is_reached_without(of, options.tolerance, report, samples);
    case PlanObstacle::Kind::reach:
      return !is_reached_without(of, options.tolerance, report, samples);
    default: return gets_farther(of, options, report);
  }
}

void run_case(const PlanCase& of, std::uint64_t seed, bool is_verbose, Figures& figures) {
  const auto pose = make_pose(*of.rig.character, of.timing.pose);
  const auto path = plan::TargetPath::create(of.rig.character, of.target, *pose);
  PlanOptions options;
  options.tolerance = std::max(0.001 * of.rig.size, 0.01 * path->length());
  options.spacing = 0.002 * of.rig.size;
  options.clearance = 0.005 * of.rig.size;
  std::optional<Result<PlannedMotion>> result;
  const double seconds = cpu_seconds_of(
      [&] { result = plan_motion(of.rig.character, of.target, of.timing, of.tool, options); });
  ++figures.cases;
  figures.seconds.push_back(seconds);
  if (!*result) {
    std::printf("case %llu: %s\n", static_cast<unsigned long long>(seed),
                std::string((*result).error().text()).c_str());
    return;
  }
  const PlannedMotion& planned = **result;
  const PlanReport& report = planned.report;
  const auto samples = plan::sample_target(*of.rig.character, *path, of.timing, 200);
  LinkDepth links(of);
  const bool is_reachable =
      MotionSearch(of, options.tolerance, links).find(*samples, [&](const RobotTrajectory& motion) {
        return makes_wound(of, motion, *path, options.tolerance);
      });
  const bool is_ok = report.is_reachable && report.hausdorff <= options.tolerance;
  figures.reachable += is_reachable ? 1 : 0;
  figures.reached += is_reachable && is_ok ? 1 : 0;
  double frame = std::numeric_limits<double>::quiet_NaN();
  bool is_true = false;
  if (report.is_reachable) {
    ++figures.planned;
    figures.hausdorff_ok += is_ok ? 1 : 0;
    figures.over_limits += leaves_limits(of.tool, planned.trajectory) ? 1 : 0;
    const LinkPlaces links_at = look_at_links(of, planned.trajectory);
    figures.penetrations += links_at.deepest > 1e-3 * of.rig.size ? 1 : 0;
    figures.overlaps += links_at.least_gap < -1e-3 * of.rig.size ? 1 : 0;
    if (links_at.deepest > 1e-3 * of.rig.size && is_verbose)
      std::printf("    a vertex is %.4f below the surface, clearance %.4f\n",
                  links_at.deepest / of.rig.size, report.least_clearance / of.rig.size);
    if (links_at.least_gap <= 0 && is_verbose)
      std::printf("    links are %.5f inside of one another, by the plan %.5f apart\n",
                  -links_at.least_gap / of.rig.size, report.least_self_clearance / of.rig.size);
    frame = frame_hausdorff(of, *path, report);
    figures.hausdorff.push_back(report.hausdorff / options.tolerance);
    figures.frame_hausdorff.push_back(frame / options.tolerance);
    figures.place.push_back(report.most_place_error / options.tolerance);
    figures.depth.push_back(report.mean_depth_error / of.target.depth[0]);
    figures.angle.push_back(report.mean_angle_error);
  } else {
    ++figures.causes;
    is_true = are_true(of, options, planned, *path, *samples);
    figures.causes_true += is_true ? 1 : 0;
  }
  if (seed % 5 == 0) {
    ++figures.repeated;
    const auto again = plan_motion(of.rig.character, of.target, of.timing, of.tool, options);
    figures.same += again && again->trajectory.values == planned.trajectory.values ? 1 : 0;
  }
  if (!is_verbose) return;
  std::printf(
      "%3llu %-20s %-8s oracle %d plan %d part %.2f-%.2f  lips %.2f frame %.2f of tol  %.2f s",
      static_cast<unsigned long long>(seed), of.rig.name.c_str(), of.arm.c_str(), is_reachable,
      report.is_reachable, report.first_share, report.last_share,
      report.hausdorff / options.tolerance, frame / options.tolerance, seconds);
  for (const PlanObstacle& obstacle : report.obstacles)
    std::printf("  [%d %s %.2f]", static_cast<int>(obstacle.kind), obstacle.value.c_str(),
                obstacle.at);
  std::printf("%s\n", report.is_reachable ? "" : is_true ? " true" : " FALSE");
  std::fflush(stdout);
}

double share(int part, int of) {
  return of == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(part) / of;
}

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

void print_summary(const Figures& figures) {
  JsonObject summary;
  summary.add("plan_cases", figures.cases);
  summary.add("plan_reachable_by_search", figures.reachable);
  summary.add("plan_reached", finite(share(figures.reached, figures.reachable)));
  summary.add("plan_hausdorff_ok", finite(share(figures.hausdorff_ok, figures.planned)));
  summary.add("plan_hausdorff_median", finite(median(figures.hausdorff)));
  summary.add("plan_vs_ik", finite(median(figures.frame_hausdorff) / median(figures.hausdorff)));
  summary.add("plan_depth_error_median", finite(median(figures.depth)));
  summary.add("plan_angle_error_median", finite(median(figures.angle)));
  summary.add("plan_seconds_median", finite(median(figures.seconds)));
  summary.add("plan_same", finite(share(figures.same, figures.repeated)));
  summary.add("plan_penetrations", figures.penetrations);
  summary.add("plan_overlaps", figures.overlaps);
  summary.add("plan_over_limits", figures.over_limits);
  summary.add("plan_causes", figures.causes);
  summary.add("plan_causes_true", finite(share(figures.causes_true, figures.causes)));
  summary.end();
}

}  // namespace

int main(int argc, char** argv) {
  int wanted = 100;
  bool is_summary = false;
  std::uint64_t first = 0;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--summary") == 0) is_summary = true;
    if (std::strcmp(argv[i], "--first") == 0 && i + 1 < argc)
      first = static_cast<std::uint64_t>(std::atoi(argv[++i]));
    if (std::strcmp(argv[i], "--cases") == 0 && i + 1 < argc) wanted = std::atoi(argv[++i]);
  }
  const std::vector<MovingRig> rigs = moving_rigs();
  const std::vector<Arm> known = arms();
  Figures figures;
  for (std::uint64_t seed = first; figures.cases < wanted && seed < first + 10'000; ++seed)
    if (const auto made = make_case(rigs, known, seed)) run_case(*made, seed, !is_summary, figures);
  print_summary(figures);
}
