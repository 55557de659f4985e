#include <sunder/io/trajectory_file.h>

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/messages/json_file.h"
#include "tools/messages/lines.h"
#include "tools/messages/output_file.h"
#include "tools/messages/overwriting.h"
#include "tools/messages/printed.h"
#include "tools/messages/text_file.h"
#include "tools/messages/written_file.h"
#include "tools/model/load_notes.h"
#include "tools/plan/hand_file.h"
#include "tools/plan/plan_inputs.h"
#include "tools/plan/plan_report.h"
#include "tools/plan/score.h"

namespace sunder::tools {
namespace {

/// The first output that cannot be written, or would overwrite a file that is read; empty if there
/// is none.
std::string fault_of_outputs(const PlanRequest& request) {
  std::vector<NamedFile> inputs = {{"MODEL", request.model}};
  if (!request.curve.empty()) inputs.push_back({"--curve", request.curve});
  if (request.like) inputs.push_back({"--like", *request.like});
  std::vector<NamedFile> outputs;
  if (!request.robot.trajectory.empty()) outputs.push_back({"--output", request.robot.trajectory});
  if (request.score) inputs.push_back({"--score", *request.score});
  if (!request.robot.robot.empty()) inputs.push_back({"--robot", request.robot.robot});
  if (request.hand) outputs.push_back({"--hand", *request.hand});
  if (request.tear) outputs.push_back({"--tear", *request.tear});
  if (request.picture) outputs.push_back({"--picture", *request.picture});
  if (request.report) outputs.push_back({"--report", *request.report});
  const std::string fault = overwriting(inputs, outputs);
  return fault.empty() ? impossible_output(outputs) : fault;
}

/// Places a hand above the curve.
ExitCode make_hand(const PlanRequest& request, PlanInputs& run) {
  Result<PlanTool> hand =
      free_hand(run.loaded.character, run.target, run.timing, request.hand_blade);
  if (!hand)
    return complain(request.like.value_or(request.curve).string(), hand.error(), ExitCode::usage);
  run.tool = std::move(*hand);
  // Robots have z up and characters y: what load_robot() turns.
  Affine3d model_from_file = Affine3d::Identity();
  model_from_file.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  Affine3d root_from_hand = run.tool.world_from_root;
  root_from_hand.linear() =
      model_from_file.linear().transpose() * run.tool.world_from_root.linear();
  root_from_hand.translation() =
      model_from_file.linear().transpose() * run.tool.world_from_root.translation();
  run.hand = hand_urdf(root_from_hand, request.hand_blade);
  return ExitCode::ok;
}

/// Writes trajectory, hand and report: all or none.
ExitCode write_plan(const PlanRequest& request, const PlanInputs& run, const PlannedMotion& planned,
                    const std::optional<PlannedBase>& base) {
  std::vector<std::pair<std::filesystem::path, std::string>> files;
  if (planned.report.is_reachable) {
    const Result<std::string> csv = trajectory_csv(planned.trajectory);
    if (!csv) return complain("--output", csv.error(), ExitCode::internal_error);
    files.emplace_back(request.robot.trajectory, *csv);
    if (request.hand) files.emplace_back(*request.hand, run.hand);
  }
  if (request.report)
    files.emplace_back(*request.report, dump(plan_json(request, planned.report, base)));
  std::deque<StagedFile> staged;  // which cannot be moved
  for (const auto& [file, text] : files) {
    staged.emplace_back(file, bytes_of(text));
    if (!staged.back().status())
      return complain(file.string(), staged.back().status(), ExitCode::unreadable_input);
  }
  for (std::size_t i = 0; i < staged.size(); ++i)
    if (const Status status = staged[i].commit(); !status)
      return complain(files[i].first.string(), status, ExitCode::unreadable_input);
  return ExitCode::ok;
}

/// Tears the model as `sunder tear --robot --trajectory` does it.
ExitCode tear_planned(const PlanRequest& request) {
  TearRequest tear;
  tear.model = request.model;
  tear.robot = request.robot;
  if (request.hand) {
    tear.robot->robot = *request.hand;
    tear.robot->link = "blade";
    tear.robot->base = Vec3d(0, 0, request.hand_blade);
    tear.robot->tip = Vec3d::Zero();
    tear.robot->place = Affine3d::Identity();
  }
  tear.robot->options = request.options.tear;
  tear.output = request.tear;
  tear.picture = request.picture;
  tear.reading = request.reading;
  tear.budget = request.budget;
  tear.verbosity = Verbosity::quiet;
  return run_tear(tear);
}

}  // namespace

ExitCode run_plan(const PlanRequest& request) {
  if (const std::string fault = fault_of_outputs(request); !fault.empty()) {
    print_error("sunder: " + fault);
    return ExitCode::usage;
  }
  const Messages messages(request.verbosity);
  std::optional<Budget> budget(std::in_place, request.budget, request.model.string());
  PlanInputs run;
  if (const ExitCode code = read_character(request, messages, run); code != ExitCode::ok)
    return code;
  if (request.score) return score_performed(request, messages, run);
  const ExitCode code = request.hand ? make_hand(request, run) : read_robot(request, messages, run);
  if (code != ExitCode::ok) return code;
  PlanOptions options = request.options;
  options.spacing = request.robot.spacing;
  const Result<PlannedMotion> planned =
      plan_motion(run.loaded.character, run.target, run.timing, run.tool, options);
  if (!planned) return complain("plan", planned.error(), ExitCode::usage);
  std::optional<PlannedBase> base;
  if (!planned->report.is_reachable && !request.hand) {
    Result<std::optional<PlannedBase>> found =
        find_base(run.loaded.character, run.target, run.timing, run.tool, options);
    if (!found) return complain("plan", found.error(), ExitCode::usage);
    base = std::move(*found);
  }
  budget.reset();
  if (const ExitCode written = write_plan(request, run, *planned, base); written != ExitCode::ok)
    return written;
  if (request.verbosity != Verbosity::quiet) print_text(plan_summary(planned->report));
  for (const PlanObstacle& obstacle : planned->report.obstacles)
    messages.warn(obstacle_text(obstacle));
  if (base) {
    const Vec3d place = place_of_base(request, *base);
    messages.warn(printed("the robot makes all of the curve with --robot-place %.6g,%.6g,%.6g",
                          place.x(), place.y(), place.z()));
  }
  if (!planned->report.is_reachable) return ExitCode::findings;
  const ExitCode torn = request.tear ? tear_planned(request) : ExitCode::ok;
  if (torn != ExitCode::ok) return torn;
  return has_losses(run.loaded.report) ? ExitCode::findings : ExitCode::ok;
}

}  // namespace sunder::tools
