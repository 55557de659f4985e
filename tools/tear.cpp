#include <sunder/io/load_character.h>
#include <sunder/io/operation_log.h>
#include <sunder/io/save_glb.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "tools/picture.h"
#include "tools/progress_bar.h"
#include "tools/report.h"
#include "tools/torn_picture.h"
#include "tools/verbs.h"
#include "tools/written_influences.h"

namespace sunder::tools {
namespace {

/// A text that is on disk before the model is written, and appears under its name after it: a failure leaves neither.
class TextBesideModel {
 public:
  /// Without a file nothing happens.
  TextBesideModel(const std::optional<std::filesystem::path>& file, const std::string& text) {
    if (file) staged_.emplace(*file, text);
  }

  [[nodiscard]] Status status() const { return staged_ ? staged_->status() : Status(); }
  [[nodiscard]] Status commit() { return staged_ ? staged_->commit() : Status(); }

 private:
  std::optional<StagedText> staged_;
};

/// @return false, after saying so, where there is no picture.
bool draw_picture(const LoadedCharacter& loaded, const TornModel& model, const std::filesystem::path& png) {
  const std::vector<Operation> history = model.history();
  Status status;
  if (history.empty())
    status = Status::failure(StatusCode::empty_input, kNone, "nothing was done that could be drawn");
  else if (!can_draw())
    status = Status::failure(StatusCode::not_found, kNone,
                             "f3d and xvfb-run are not both installed (Debian: apt install f3d xvfb xauth)");
  else
    status = draw_torn(loaded.character, history, png);
  if (!status) (void)complain(png.string(), status, ExitCode::findings);
  return static_cast<bool>(status);
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
    const Result<OperationOutcome> outcome = play((*operations)[i], current, *model);
    if (!outcome)
      return complain(request.operations.string() + ": /operations/" + std::to_string(i), outcome.error(), ExitCode::usage);
    current = outcome->after;
    has_findings |= outcome->has_missed || outcome->tear.blocked > 0;
    reports.push_back(to_json(*outcome, model->character()));
  }

  progress.begin_step(operations->size() + 1, "writing");
  const Result<PruningLoss> pruning_loss = measure_pruning(*model, request.save.maximum_influences);
  if (!pruning_loss) return complain(request.output.string(), pruning_loss.error(), ExitCode::internal_error);
  const Json report = {{"sunder_report", 1},
                       {"model", request.model.string()},
                       {"output", request.output.string()},
                       {"loading", to_json(loaded->report)},
                       {"operations", std::move(reports)},
                       {"influences_written_max", request.save.maximum_influences},
                       {"influences_written", to_json(*pruning_loss, request.save)},
                       {"result", result_json(*model, source, current)}};
  has_findings |=
      current.non_manifold_edges > source.non_manifold_edges || current.degenerate_triangles > source.degenerate_triangles;

  TextBesideModel report_file(request.report, dump(report));
  if (const Status status = report_file.status(); !status)
    return complain(request.report->string(), status, ExitCode::unreadable_input);
  TextBesideModel log_file(request.log, request.log ? format_operations(model->history()) : std::string());
  if (const Status status = log_file.status(); !status) return complain(request.log->string(), status, ExitCode::unreadable_input);
  if (const Status status = save_glb(request.output, model->character(), *loaded, request.save); !status)
    return complain(request.output.string(), status, ExitCode::internal_error);
  if (const Status status = log_file.commit(); !status) return complain(request.log->string(), status, ExitCode::unreadable_input);
  if (const Status status = report_file.commit(); !status)
    return complain(request.report->string(), status, ExitCode::unreadable_input);
  if (request.picture) has_findings |= !draw_picture(*loaded, *model, *request.picture);
  if (!request.report) std::fputs(dump(report).c_str(), stdout);
  return has_findings ? ExitCode::findings : ExitCode::ok;
}

}  // namespace sunder::tools
