#include <sunder/io/load_character.h>
#include <sunder/io/operation_log.h>
#include <sunder/io/save_glb.h>
#include <sunder/skinning/pose_spec.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "tools/progress_bar.h"
#include "tools/report.h"
#include "tools/verbs.h"

namespace sunder::tools {
namespace {

Result<OperationOutcome> apply(const Operation& any, const TopologyCounts& before, TornModel& model) {
  const auto* const simple = std::get_if<TearOperation>(&any);
  if (simple == nullptr || simple->options != TearOptions{} || !simple->pose_changes.empty())
    return Status::failure(StatusCode::unsupported_feature, kNone, "only tears without width, in one pose, are supported");
  const TearOperation& operation = *simple;
  const Result<ModelPose> pose = make_pose(model.character(), operation.pose);
  if (!pose) return pose.error();
  const auto begin = std::chrono::steady_clock::now();
  const Result<TearReport> tear = model.tear(*pose, operation.stroke);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  if (!tear) return tear.error();
  return OperationOutcome{*tear, elapsed.count(), before, tear->runs == 0 ? before : count_topology(model.character())};
}

}  // namespace

ExitCode run_tear(const TearRequest& request) {
  const Result<std::vector<Operation>> operations = load_operations(request.operations);
  if (!operations) return complain(request.operations.string(), operations.error(), ExitCode::usage);

  ProgressBar progress(operations->size() + 2);
  progress.begin_step(0, "reading");
  const Result<LoadedCharacter> loaded = load_character(request.model);
  if (!loaded) return complain(request.model.string(), loaded.error(), ExitCode::unreadable_input);
  Result<TornModel> model = TornModel::create(loaded->character);
  if (!model) return complain(request.model.string(), model.error(), ExitCode::internal_error);

  const TopologyCounts source = count_topology(*loaded->character);
  TopologyCounts current = source;
  Json reports = Json::array();
  bool has_findings = false;
  for (std::size_t i = 0; i < operations->size(); ++i) {
    progress.begin_step(i + 1, "tearing");
    const Result<OperationOutcome> outcome = apply((*operations)[i], current, *model);
    if (!outcome)
      return complain(request.operations.string() + ": /operations/" + std::to_string(i), outcome.error(), ExitCode::usage);
    current = outcome->after;
    has_findings |= outcome->has_missed() || outcome->tear.blocked > 0;
    reports.push_back(to_json(*outcome));
  }

  progress.begin_step(operations->size() + 1, "writing");
  Json report = {{"sunder_report", 1},
                 {"model", request.model.string()},
                 {"output", request.output.string()},
                 {"loading", to_json(loaded->report)},
                 {"operations", std::move(reports)},
                 {"influences_written_max", request.maximum_influences},
                 {"result", result_json(model->character(), source, current)}};
  has_findings |=
      current.non_manifold_edges > source.non_manifold_edges || current.degenerate_triangles > source.degenerate_triangles;

  // The report is on disk before the model is written, and appears after it: a failure leaves neither.
  std::optional<StagedText> staged;
  if (request.report) {
    staged.emplace(*request.report, dump(report));
    if (!staged->status()) return complain(request.report->string(), staged->status(), ExitCode::unreadable_input);
  }
  SaveOptions options;
  options.maximum_influences = request.maximum_influences;
  if (const Status status = save_glb(request.output, model->character(), *loaded, options); !status)
    return complain(request.output.string(), status, ExitCode::internal_error);
  if (!staged)
    std::fputs(dump(report).c_str(), stdout);
  else if (const Status status = staged->commit(); !status)
    return complain(request.report->string(), status, ExitCode::unreadable_input);
  return has_findings ? ExitCode::findings : ExitCode::ok;
}

}  // namespace sunder::tools
