#include "tools/tear/tear_play.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include "tools/messages/printed.h"
#include "tools/model/history.h"
#include "tools/tear/miss.h"
#include "tools/tear/operation_line.h"
#include "tools/tear/plain_tears.h"
#include "tools/tear/stroke_warnings.h"
#include "tools/value_of.h"

namespace sunder::tools {
namespace {

/// The operations whose weight errors are measured, at most; each takes O(vertices of the source).
constexpr std::size_t kMostMeasured = 100;

/// The misses for whose cause is looked, at most; each takes some forty attempts.
constexpr std::size_t kMostExplained = 3;

/// The times beyond the end of a clip that are named, at most; a stroke may have thousands.
constexpr std::size_t kMostTimeWarnings = 3;

/// An operation that was applied, and where.
struct Played {
  const Operation& operation;
  std::string place;  ///< "/operations/3".
  OperationOutcome outcome;
  TriangleCounts before;
};

/// Says what an operation did, and warns of faults of strokes.
Status describe(const Played& played, TearRun& run) {
  std::optional<TornPlace> place;
  const std::vector<PoseSpec> specs = pose_specs_of(played.operation);
  if (!specs.empty()) {
    const Result<ModelPose> pose = make_pose(run.model.source(), specs.front());
    if (!pose) return pose.error();
    place = torn_place(run.model, played.before, *pose);
    const auto* const tear = std::get_if<TearOperation>(&played.operation);
    if (tear != nullptr && place) {
      const auto warnings = stroke_warnings(*tear, *pose, *place, run.posed_source);
      if (!warnings) return warnings.error();
      for (const std::string& warning : *warnings) run.messages.warn(played.place + ": " + warning);
    }
  }
  run.messages.say(played.place + ": " + operation_line(played.outcome, place));
  run.messages.detail(played.place + ": " + operation_details(played.outcome));
  return {};
}

/// Which way to move a robot whose blade missed, and when it was nearest.
std::string robot_advice(const RobotTear& robot, const Miss& miss) {
  if (!miss.place || miss.blade >= robot.times.size()) return {};
  return printed(
      "; that is at %.4g s of the motion: add %s to --robot-place, and the depth of the "
      "tear in the same direction; `sunder picture --robot` shows it",
      robot.times[miss.blade], point_text(miss.way).c_str());
}

/// Says by how much an operation missed, and adds that to its report.
Status describe_miss(const Played& played, TearRun& run, Json& report) {
  Result<Miss> miss = measure_miss(played.operation, run.model, run.posed_source);
  if (!miss) return miss.error();
  if (run.totals.missed <= kMostExplained) {
    const Result<std::string> cause =
        cause_of_miss(played.operation, *miss, run.model, run.loaded.character);
    if (!cause) return cause.error();
    miss->cause = *cause;
  }
  const std::string text = played.place + ": " + played.outcome.op +
                           " missed: " + miss_text(played.operation, *miss) +
                           (played.place == "--robot" ? robot_advice(*run.robot, *miss) : "");
  if (run.messages.is_quiet())
    print_error("sunder: " + text);  // A stroke that misses is never silent.
  else
    run.messages.warn(text);
  report["miss"] = to_json(*miss);
  return {};
}

void add_to_totals(const OperationOutcome& outcome, TearRun& run) {
  RunTotals& totals = run.totals;
  ++(outcome.has_missed ? totals.missed : totals.done);
  totals.pieces += outcome.tear.pieces.size();
  totals.faces_crossed += outcome.tear.faces_crossed;
  totals.blocked += outcome.tear.blocked;
  run.times.operations += outcome.seconds;
  run.has_findings |= outcome.has_missed || outcome.tear.blocked > 0;
}

/// With --count-topology, counts what an operation changed.
Status count(TearRun& run, TopologyCounts& current, OperationOutcome& outcome) {
  if (!run.request.count_topology) return {};
  const TopologyCounts before = current;
  if (!outcome.has_missed) {
    const Result<TopologyCounts> counts = count_topology(run.model.character());
    if (!counts) return counts.error();
    current = *counts;
  }
  outcome.topology = TopologyChange{before, current};
  return {};
}

/// Applies one operation, describes and reports it.
/// @param current  the topology, with --count-topology.
/// @param is_measured  whether its weight error is.
Status play_one(const Operation& operation, const std::string& place, bool is_measured,
                TopologyCounts& current, TearRun& run) {
  const std::vector<std::string> warnings = time_warnings(operation, run.model.source());
  for (std::size_t i = 0; i < std::min(warnings.size(), kMostTimeWarnings); ++i)
    run.messages.warn(place + ": " + warnings[i]);
  if (warnings.size() > kMostTimeWarnings)
    run.messages.warn(place + ": and so are " +
                      std::to_string(warnings.size() - kMostTimeWarnings) + " later times");
  TriangleCounts before = triangle_counts(run.model.character());
  Result<OperationOutcome> outcome =
      play(operation, run.model, run.pieces ? &*run.pieces : nullptr);
  if (!outcome) return outcome.error();
  Played played{operation, place, std::move(*outcome), std::move(before)};
  if (const Status status = count(run, current, played.outcome); !status) return status;
  if (is_measured)
    if (const Status status = measure_weight_error(operation, run.model, played.outcome); !status)
      return status;
  add_to_totals(played.outcome, run);
  if (!played.outcome.has_missed) run.played.push_back(operation);
  const bool is_reported = run.request.report.has_value();
  Json report = is_reported ? to_json(played.outcome, run.model.character()) : Json::object();
  Status status;
  if (played.outcome.has_missed)
    status = describe_miss(played, run, report);
  else if (!run.messages.is_quiet())
    status = describe(played, run);
  if (is_reported) run.reports.push_back(std::move(report));
  return status;
}

/// Whether a piece that is to come off came off with another one: a cap joins the skin of a head to
/// the mouth inside it.
bool has_come_off(const Operation& detachment, const TornModel& model) {
  const auto& detach = std::get<DetachOperation>(detachment);
  const auto* const place = std::get_if<PieceOfTriangle>(&detach.piece);
  return place != nullptr &&
         is_retired(model.character().meshes[place->mesh].triangles[place->triangle]);
}

/// Applies a wanted operation, and takes off what it severs.
Status play_wanted(const WantedOperation& wanted, bool is_measured, TopologyCounts& current,
                   TearRun& run) {
  const Result<PlainTears> tears = plain_tears(wanted, run);
  if (!tears) return tears.error();
  for (const std::string& note : tears->notes) run.messages.say(wanted.place + ": " + note);
  const std::size_t missed = run.totals.missed;
  if (const Status status = play_one(tears->operation, wanted.place, is_measured, current, run);
      !status)
    return status;
  if (run.totals.missed > missed) return {};
  for (const Operation& detachment : tears->detachments) {
    if (has_come_off(detachment, run.model)) continue;
    if (const Status status = play_one(detachment, wanted.place, false, current, run); !status)
      return status;
  }
  return {};
}

}  // namespace

ExitCode play_operations(const std::vector<WantedOperation>& operations, TearRun& run,
                         ProgressBar& progress) {
  TopologyCounts current = run.source;
  const std::size_t step = 1 + operations.size() / kMostMeasured;
  for (std::size_t i = 0; i < operations.size(); ++i) {
    progress.begin_step(i + 1, "tearing");
    const WantedOperation& wanted = operations[i];
    const std::string place =
        wanted.file.empty() ? wanted.place : wanted.file + ": " + wanted.place;
    run.budget.begin(place);
    const bool is_measured = run.request.weight_errors && i % step == 0;
    const Status status = play_wanted(wanted, is_measured, current, run);
    if (status) continue;
    const ExitCode code =
        complain(place, status, ExitCode::usage, advice_on(wanted, run.model.source()));
    if (!run.request.keep_going || code != ExitCode::usage) return code;
    ++run.totals.refused;
    run.has_findings = true;
  }
  run.budget.begin(run.request.model.string());
  progress.begin_step(operations.size() + 1, "weighing");
  if (!run.weighing.refit) return ExitCode::ok;
  for (const WeightsOperation& refit :
       refits_of(value_of(run.model.history()), *run.weighing.refit))
    if (const Status status = play_one(refit, "--weights refit", false, current, run); !status)
      return complain(run.request.model.string() + ": --weights refit", status, ExitCode::usage);
  return ExitCode::ok;
}

}  // namespace sunder::tools
