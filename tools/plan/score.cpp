#include "tools/plan/score.h"

#include <sunder/io/operation_log.h>
#include <sunder/io/trajectory_file.h>

#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tools/messages/json_file.h"
#include "tools/messages/output_file.h"
#include "tools/messages/printed.h"
#include "tools/model/load_notes.h"

namespace sunder::tools {
namespace {

constexpr double kBladesPerSecond = 240;  ///< Of a robot's motion.
constexpr double kDegreesOfRadian = 180 / std::numbers::pi;

/// A stroke, and when its blades were where they are; without times they are not known.
struct Performed {
  TearOperation tear;
  std::vector<double> times;
};

bool is_log(const std::filesystem::path& file) {
  if (file.extension() != ".json") return false;
  const Result<Json> json = read_json_object(file);
  return json && json->contains("sunder_operations");
}

/// The times of a stroke of a log: those of the rate, or of the clip while it runs.
std::vector<double> times_of(const PlanRequest& request, const TearOperation& tear) {
  std::vector<double> times;
  const std::size_t count = tear.stroke.size();
  if (request.score_rate > 0)
    for (std::size_t i = 0; i < count; ++i)
      times.push_back(static_cast<double>(i) / request.score_rate);
  const auto* const first = std::get_if<ClipPose>(&tear.pose);
  if (request.score_rate > 0 || request.robot.clip_speed == 0 || first == nullptr ||
      tear.pose_changes.size() + 1 != count)
    return times;
  times.push_back(0);
  for (const TearOperation::PoseChange& change : tear.pose_changes) {
    const auto* const later = std::get_if<ClipPose>(&change.pose);
    if (later == nullptr) return {};
    times.push_back((later->time - first->time) / request.robot.clip_speed);
  }
  return times;
}

ExitCode read_log(const PlanRequest& request, const PlanInputs& inputs, Performed& performed) {
  const std::string file = request.score->string();
  Result<std::vector<Operation>> operations =
      load_operations(*request.score, inputs.loaded.character.get());
  if (!operations) return complain(file, operations.error(), ExitCode::usage);
  std::vector<TearOperation> tears;
  for (Operation& operation : *operations)
    if (auto* const tear = std::get_if<TearOperation>(&operation))
      tears.push_back(std::move(*tear));
  if (tears.size() != 1)
    return complain(file,
                    Status::failure(StatusCode::invalid_argument, kNone,
                                    "the log has %zu tears; expected one", tears.size()),
                    ExitCode::usage);
  performed.tear = std::move(tears.front());
  performed.times = times_of(request, performed.tear);
  return ExitCode::ok;
}

ExitCode read_trajectory(const PlanRequest& request, const Messages& messages, PlanInputs& inputs,
                         Performed& performed) {
  const std::string file = request.score->string();
  if (request.robot.robot.empty())
    return complain(file,
                    Status::failure(StatusCode::invalid_argument, kNone,
                                    "a trajectory needs --robot and --blade; a log, "
                                    "{\"sunder_operations\": 1, ...}, does not"),
                    ExitCode::usage);
  if (const ExitCode code = read_robot(request, messages, inputs); code != ExitCode::ok)
    return code;
  const Result<RobotTrajectory> trajectory = load_trajectory(*request.score);
  if (!trajectory) return complain(file, trajectory.error(), ExitCode::usage);
  const Result<RobotMotion> motion = RobotMotion::create(inputs.tool.robot, *trajectory);
  if (!motion) return complain(file, motion.error(), ExitCode::usage);
  SweepOptions options;
  options.spacing = request.robot.spacing;
  options.seconds = 1 / kBladesPerSecond;
  Result<BladeSweep> sweep =
      sweep_blade(*motion, inputs.tool.blade, inputs.tool.world_from_root, options);
  if (!sweep) return complain(file, sweep.error(), ExitCode::usage);
  Result<TearOperation> tear = tear_of_sweep(*sweep, inputs.timing.pose, inputs.timing.clip_speed);
  if (!tear) return complain(file, tear.error(), ExitCode::usage);
  performed = {std::move(*tear), std::move(sweep->times)};
  return ExitCode::ok;
}

Json score_error_json(const StrokeScore::Error& error, double unit = 1) {
  return {{"most", unit * error.most}, {"mean", unit * error.mean}};
}

Json known(const std::optional<double>& number) { return number ? Json(*number) : Json(); }

Json score_json(const PlanRequest& request, const StrokeScore& score) {
  Json json = {{"sunder_score", 1},
               {"model", request.model.string()},
               {"curve", request.like.value_or(request.curve).string()},
               {"performed", request.score->string()},
               {"pose", request.robot.pose},
               {"clip_speed", request.robot.clip_speed},
               {"units", {{"length", "m"}, {"angle", "degree"}, {"time", "s"}, {"mark", "0-100"}}},
               {"curve_length", score.curve_length},
               {"tolerance", score.tolerance},
               {"blades", score.blades},
               {"is_backwards", score.is_backwards},
               {"covered", score.covered}};
  const bool is_cut = score.blades > 0;
  json["place_error"] = is_cut ? score_error_json(score.place) : Json();
  json["wanted_depth"] = is_cut ? Json(score.wanted_depth) : Json();
  json["too_deep"] = is_cut ? score_error_json(score.too_deep) : Json();
  json["too_shallow"] = is_cut ? score_error_json(score.too_shallow) : Json();
  json["angle_error"] = is_cut ? score_error_json(score.angle, kDegreesOfRadian) : Json();
  json["pace"] = Json();
  if (const auto& pace = score.pace)
    json["pace"] = {
        {"seconds", pace->seconds},           {"speed", pace->speed},
        {"wanted_speed", pace->wanted_speed}, {"unevenness", pace->unevenness},
        {"log_jerk", known(pace->log_jerk)},  {"wanted_log_jerk", known(pace->wanted_log_jerk)}};
  const StrokeScore::Marks& marks = score.marks;
  json["marks"] = {{"whole", marks.whole},
                   {"covered", marks.covered},
                   {"place", marks.place},
                   {"depth", marks.depth},
                   {"angle", marks.angle},
                   {"speed", known(marks.speed)},
                   {"smoothness", known(marks.smoothness)}};
  return json;
}

std::string score_summary(const StrokeScore& score) {
  const StrokeScore::Marks& marks = score.marks;
  std::string text = printed("mark        %.0f of 100%s\n", marks.whole,
                             score.is_backwards ? ", from the curve's end to its begin" : "");
  text += printed("covered     %.0f: %.0f %% of the curve's %.4g m\n", marks.covered,
                  100 * score.covered, score.curve_length);
  if (score.blades == 0) return text;
  text += printed("place       %.0f: off by %.3g m at most, %.3g on average; tolerance %.3g m\n",
                  marks.place, score.place.most, score.place.mean, score.tolerance);
  text += printed(
      "depth       %.0f: too deep by %.3g m at most, %.3g on average; too shallow by "
      "%.3g at most, %.3g on average\n",
      marks.depth, score.too_deep.most, score.too_deep.mean, score.too_shallow.most,
      score.too_shallow.mean);
  text += printed("angle       %.0f: off by %.3g degrees at most, %.3g on average\n", marks.angle,
                  kDegreesOfRadian * score.angle.most, kDegreesOfRadian * score.angle.mean);
  if (!score.pace) return text + "speed       not known: no times\n";
  text += printed("speed       %.0f: %.3g m/s of %.3g, uneven by %.0f %%\n", *marks.speed,
                  score.pace->speed, score.pace->wanted_speed, 100 * score.pace->unevenness);
  return text + (marks.smoothness
                     ? printed("smoothness  %.0f: log jerk %.3g of %.3g\n", *marks.smoothness,
                               *score.pace->log_jerk, *score.pace->wanted_log_jerk)
                     : std::string("smoothness  not known: too few blades\n"));
}

}  // namespace

ExitCode score_performed(const PlanRequest& request, const Messages& messages, PlanInputs& inputs) {
  Performed performed;
  const ExitCode read = is_log(*request.score)
                            ? read_log(request, inputs, performed)
                            : read_trajectory(request, messages, inputs, performed);
  if (read != ExitCode::ok) return read;
  const Result<StrokeScore> score =
      score_stroke(inputs.loaded.character, inputs.target, inputs.timing, performed.tear,
                   performed.times, request.options.tolerance);
  if (!score) return complain("plan", score.error(), ExitCode::usage);
  if (request.report) {
    StagedFile staged(*request.report, bytes_of(dump(score_json(request, *score))));
    Status status = staged.status();
    if (status) status = staged.commit();
    if (!status) return complain(request.report->string(), status, ExitCode::unreadable_input);
  }
  if (request.verbosity != Verbosity::quiet) print_text(score_summary(*score));
  if (score->blades == 0) messages.warn("the blade does not cross the surface");
  return score->blades == 0 || has_losses(inputs.loaded.report) ? ExitCode::findings : ExitCode::ok;
}

}  // namespace sunder::tools
