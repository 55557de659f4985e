#include <sunder/io/character_file.h>
#include <sunder/io/operation_log.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/picture.h"
#include "tools/progress_bar.h"
#include "tools/refit.h"
#include "tools/report.h"
#include "tools/torn_picture.h"
#include "tools/verbs.h"
#include "tools/weight_report.h"
#include "tools/written_influences.h"

namespace sunder::tools {
namespace {

/// A text that is on disk before the model is written, and appears under its name after it: a
/// failure leaves neither.
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

/// How the model weighs, from the command line.
struct Weighing {
  WeightOptions options;
  std::optional<RefitOver> refit_over;  ///< Of `refit`, where the model bends.
};

Result<Weighing> choose_weighing(const TearRequest& request,
                                 const std::shared_ptr<const Character>& character) {
  Weighing weighing;
  if (!request.weights) return weighing;
  weighing.options.policy = *request.weights;
  if (*request.weights != WeightPolicy::exact)
    weighing.options.maximum_influences = request.save.maximum_influences;
  if (*request.weights != WeightPolicy::refit) return weighing;
  const auto over = choose_poses(character, request.refit_over);
  if (!over) return over.error();
  weighing.refit_over = *over;
  return weighing;
}

Json to_json(const Weighing& weighing) {
  Json json = {{"policy", weight_policy_name(weighing.options.policy)},
               {"influences", weighing.options.maximum_influences},
               {"refit_over", nullptr}};
  if (weighing.refit_over) json["refit_over"] = refit_over_name(*weighing.refit_over);
  return json;
}

/// Measures the model, and what of it is in a file where that is less.
Result<Json> weight_errors_of(TornModel& model, const std::shared_ptr<const Character>& source) {
  const auto poses = poses_to_measure(model, source);
  if (!poses) return poses.error();
  Result<Json> errors = weight_errors_json(model, *poses);
  if (!errors) return errors;
  Result<Json> as_written = written_weight_errors_json(model, *poses);
  if (!as_written) return as_written;
  if (as_written->is_null()) return errors;
  (*errors)["as_written"] = std::move(*as_written);
  (*errors)["note"] =
      "a GLB cannot hold the positions per influence of the policy 'exact': there those points are "
      "barycentric";
  return errors;
}

/// @return false, after saying so, where there is no picture.
bool draw_picture(const LoadedCharacter& loaded, const TornModel& model,
                  const std::filesystem::path& png) {
  const std::vector<Operation> history = model.history();
  Status status;
  if (history.empty())
    status =
        Status::failure(StatusCode::empty_input, kNone, "nothing was done that could be drawn");
  else if (!can_draw())
    status = Status::failure(
        StatusCode::not_found, kNone,
        "f3d and xvfb-run are not both installed (Debian: apt install f3d xvfb xauth)");
  else
    status = draw_torn(loaded.character, history, png);
  if (!status) (void)complain(png.string(), status, ExitCode::findings);
  return static_cast<bool>(status);
}

}  // namespace

ExitCode run_tear(const TearRequest& request) {
  const Result<std::vector<Operation>> operations = load_operations(request.operations);
  if (!operations)
    return complain(request.operations.string(), operations.error(), ExitCode::usage);

  ProgressBar progress(operations->size() + 3);
  progress.begin_step(0, "reading");
  const Result<LoadedCharacter> loaded = load_character(request.model);
  if (!loaded) return complain(request.model.string(), loaded.error(), ExitCode::unreadable_input);
  Result<TornModel> model = TornModel::create(loaded->character);
  if (!model) return complain(request.model.string(), model.error(), ExitCode::internal_error);

  const Result<Weighing> weighing = choose_weighing(request, loaded->character);
  if (!weighing)
    return complain(request.model.string() + ": --refit-over", weighing.error(), ExitCode::usage);
  if (const Status status = model->set_weights(weighing->options); !status)
    return complain("--weights", status, ExitCode::usage);

  const TopologyCounts source = count_topology(*loaded->character);
  TopologyCounts current = source;
  Json reports = Json::array();
  bool has_findings = false;
  for (std::size_t i = 0; i < operations->size(); ++i) {
    progress.begin_step(i + 1, "tearing");
    const Result<OperationOutcome> outcome = play((*operations)[i], current, *model);
    if (!outcome)
      return complain(request.operations.string() + ": /operations/" + std::to_string(i),
                      outcome.error(), ExitCode::usage);
    current = outcome->after;
    has_findings |= outcome->has_missed || outcome->tear.blocked > 0;
    reports.push_back(to_json(*outcome, model->character()));
  }

  progress.begin_step(operations->size() + 1, "weighing");
  if (weighing->refit_over)
    for (const WeightsOperation& refit : refits_of(model->history(), *weighing->refit_over)) {
      const Result<OperationOutcome> outcome = play(refit, current, *model);
      if (!outcome)
        return complain(request.model.string() + ": --weights refit", outcome.error(),
                        ExitCode::usage);
      reports.push_back(to_json(*outcome, model->character()));
    }
  const Json result = result_json(*model, source, current);
  const Result<Json> weight_errors = weight_errors_of(*model, loaded->character);
  if (!weight_errors)
    return complain(request.output.string(), weight_errors.error(), ExitCode::internal_error);

  progress.begin_step(operations->size() + 2, "writing");
  const Result<PruningLoss> pruning_loss = measure_pruning(*model, request.save.maximum_influences);
  if (!pruning_loss)
    return complain(request.output.string(), pruning_loss.error(), ExitCode::internal_error);
  const Json report = {{"sunder_report", 1},
                       {"model", request.model.string()},
                       {"output", request.output.string()},
                       {"loading", to_json(loaded->report)},
                       {"operations", std::move(reports)},
                       {"weights", to_json(*weighing)},
                       {"weight_errors", *weight_errors},
                       {"influences_written_max", request.save.maximum_influences},
                       {"influences_written", to_json(*pruning_loss, request.save)},
                       {"result", result}};
  has_findings |= current.non_manifold_edges > source.non_manifold_edges ||
                  current.degenerate_triangles > source.degenerate_triangles;

  TextBesideModel report_file(request.report, dump(report));
  if (const Status status = report_file.status(); !status)
    return complain(request.report->string(), status, ExitCode::unreadable_input);
  TextBesideModel log_file(request.log,
                           request.log ? format_operations(model->history()) : std::string());
  if (const Status status = log_file.status(); !status)
    return complain(request.log->string(), status, ExitCode::unreadable_input);
  if (const Status status = save_glb(request.output, model->character(), *loaded, request.save);
      !status)
    return complain(request.output.string(), status, ExitCode::internal_error);
  if (const Status status = log_file.commit(); !status)
    return complain(request.log->string(), status, ExitCode::unreadable_input);
  if (const Status status = report_file.commit(); !status)
    return complain(request.report->string(), status, ExitCode::unreadable_input);
  if (request.picture) has_findings |= !draw_picture(*loaded, *model, *request.picture);
  if (!request.report) std::fputs(dump(report).c_str(), stdout);
  return has_findings ? ExitCode::findings : ExitCode::ok;
}

}  // namespace sunder::tools
