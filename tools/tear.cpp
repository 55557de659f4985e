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

#include "tools/certified_report.h"
#include "tools/certified_weights.h"
#include "tools/picture.h"
#include "tools/progress_bar.h"
#include "tools/refit.h"
#include "tools/report.h"
#include "tools/text_file.h"
#include "tools/torn_picture.h"
#include "tools/value_of.h"
#include "tools/verbs.h"
#include "tools/weight_report.h"
#include "tools/written_influences.h"

namespace sunder::tools {
namespace {

/// A text that is written before the model and renamed after it, so that a failure leaves neither.
class TextBesideModel {
 public:
  /// Does nothing without a file.
  TextBesideModel(const std::optional<std::filesystem::path>& file, const std::string& text) {
    if (file) staged_.emplace(*file, text);
  }

  [[nodiscard]] Status status() const { return staged_ ? staged_->status() : Status(); }
  [[nodiscard]] Status commit() { return staged_ ? staged_->commit() : Status(); }

 private:
  std::optional<StagedText> staged_;
};

/// The options for weights of new points, from the command line.
struct Weighing {
  WeightOptions options;
  std::optional<RefitOptions> refit;  ///< For `refit`, if the model bends.
};

Result<Weighing> choose_weighing(const TearRequest& request,
                                 const std::shared_ptr<const Character>& character) {
  Weighing weighing;
  if (!request.weights) return weighing;
  weighing.options.policy = *request.weights;
  if (*request.weights != WeightPolicy::exact)
    weighing.options.maximum_influences = request.save.maximum_influences;
  if (*request.weights != WeightPolicy::refit) return weighing;
  auto refit = choose_refit(*character, request.refit_over);
  if (!refit) return refit.error();
  weighing.refit = std::move(*refit);
  if (weighing.refit) weighing.refit->bound = request.refit_bound;
  return weighing;
}

Json weighing_json(const Weighing& weighing) {
  Json json = {{"policy", weight_policy_name(weighing.options.policy)},
               {"influences", weighing.options.maximum_influences},
               {"refit_over", nullptr}};
  if (weighing.refit) json["refit_over"] = refit_over_text(*weighing.refit);
  return json;
}

/// Measures the weights of the model, and the weights in the file if they differ.
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

/// @return false if there is no picture, which is reported.
bool draw_picture(const LoadedCharacter& loaded, const TornModel& model,
                  const std::filesystem::path& png) {
  const std::vector<Operation> history = value_of(model.history());
  Status status;
  if (history.empty())
    status = Status::failure(StatusCode::empty_input, kNone,
                             "the log has no operation that could be drawn");
  else if (!can_draw())
    status = Status::failure(StatusCode::not_found, kNone, "%s", kNoRenderer);
  else
    status = draw_torn(loaded.character, history, png);
  if (!status) (void)complain(png.string(), status, ExitCode::findings);
  return static_cast<bool>(status);
}

/// A model to which operations are applied, and their reports.
struct TearRun {
  const TearRequest& request;
  const LoadedCharacter& loaded;
  TornModel model;
  Weighing weighing;
  TopologyCounts source, current;
  Json reports = Json::array();
  std::optional<CertifiedWeights> certified = {};  ///< With --max-error.
  bool has_findings = false;
};

///
/// @return ok, or the exit code of the failure, which was reported.
ExitCode play_operations(const std::vector<Operation>& operations, TearRun& run,
                         ProgressBar& progress) {
  for (std::size_t i = 0; i < operations.size(); ++i) {
    progress.begin_step(i + 1, "tearing");
    const Result<OperationOutcome> outcome = play(operations[i], run.current, run.model);
    if (!outcome)
      return complain(run.request.operations.string() + ": /operations/" + std::to_string(i),
                      outcome.error(), ExitCode::usage);
    run.current = outcome->after;
    run.has_findings |= outcome->has_missed || outcome->tear.blocked > 0;
    run.reports.push_back(to_json(*outcome, run.model.character()));
  }
  progress.begin_step(operations.size() + 1, "weighing");
  if (!run.weighing.refit) return ExitCode::ok;
  for (const WeightsOperation& refit :
       refits_of(value_of(run.model.history()), *run.weighing.refit)) {
    const Result<OperationOutcome> outcome = play(refit, run.current, run.model);
    if (!outcome)
      return complain(run.request.model.string() + ": --weights refit", outcome.error(),
                      ExitCode::usage);
    run.reports.push_back(to_json(*outcome, run.model.character()));
  }
  return ExitCode::ok;
}

/// How the influences are written, and what that changes.
Result<Json> influences_written_json(const TearRun& run) {
  if (run.certified)
    return Json{{"maximum", 0},
                {"format", "certified"},
                {"certificate", certificate_json(*run.certified, run.model.character(),
                                                 *run.request.maximum_error)}};
  const Result<PruningLoss> loss = measure_pruning(run.model, run.request.save.maximum_influences);
  if (!loss) return loss.error();
  return to_json(*loss, run.request.save);
}

Result<Json> report_json(TearRun& run) {
  const TearRequest& request = run.request;
  const Json result = result_json(run.model, run.source, run.current);
  const Result<Json> weight_errors = weight_errors_of(run.model, run.loaded.character);
  if (!weight_errors) return weight_errors;
  const Result<Json> written = influences_written_json(run);
  if (!written) return written;
  return Json{{"sunder_report", 1},
              {"model", request.model.string()},
              {"output", request.output.string()},
              {"loading", to_json(run.loaded.report)},
              {"operations", std::move(run.reports)},
              {"weights", weighing_json(run.weighing)},
              {"weight_errors", *weight_errors},
              {"influences_written_max", request.save.maximum_influences},
              {"influences_written", *written},
              {"result", result}};
}

/// With --max-error, chooses what is written of the torn model's weights.
/// @return ok, or the exit code of the failure, which was reported.
ExitCode choose_influences(TearRun& run) {
  const std::optional<MaximumError>& wanted = run.request.maximum_error;
  if (!wanted) return ExitCode::ok;
  Result<CertifiedWeights> certified = certify_weights(run.model.character(), run.loaded, *wanted);
  if (!certified)
    return complain("--max-error, --limits " + wanted->limits, certified.error(), ExitCode::usage);
  run.certified = std::move(*certified);
  return ExitCode::ok;
}

/// Writes the model, its report and its log: all of them, or none.
ExitCode write_files(const TearRun& run, const std::string& report) {
  const TearRequest& request = run.request;
  TextBesideModel report_file(request.report, report);
  if (const Status status = report_file.status(); !status)
    return complain(request.report->string(), status, ExitCode::unreadable_input);
  TextBesideModel log_file(
      request.log,
      request.log ? value_of(format_operations(value_of(run.model.history()))) : std::string());
  if (const Status status = log_file.status(); !status)
    return complain(request.log->string(), status, ExitCode::unreadable_input);
  SaveOptions save = request.save;
  if (run.certified) save.weights_of_mesh = run.certified->formats;
  const Character& character = run.certified ? run.certified->character : run.model.character();
  if (const Status status = save_glb(request.output, character, run.loaded, save); !status)
    return complain(request.output.string(), status, ExitCode::internal_error);
  if (const Status status = log_file.commit(); !status)
    return complain(request.log->string(), status, ExitCode::unreadable_input);
  if (const Status status = report_file.commit(); !status)
    return complain(request.report->string(), status, ExitCode::unreadable_input);
  return ExitCode::ok;
}

}  // namespace

ExitCode run_tear(const TearRequest& request) {
  const Result<std::vector<Operation>> operations = load_operations(request.operations);
  if (!operations)
    return complain(request.operations.string(), operations.error(), ExitCode::usage);

  ProgressBar progress(operations->size() + 3);
  progress.begin_step(0, "reading");
  const std::string place = request.model.string();
  LoadOptions load;
  load.keep_stored_influences = request.maximum_error.has_value();
  const Result<LoadedCharacter> loaded = load_character(request.model, load);
  if (!loaded) return complain(place, loaded.error(), ExitCode::unreadable_input);
  Result<TornModel> model = TornModel::create(loaded->character);
  if (!model) return complain(place, model.error(), ExitCode::internal_error);
  const Result<Weighing> weighing = choose_weighing(request, loaded->character);
  if (!weighing) return complain(place + ": --refit-over", weighing.error(), ExitCode::usage);
  if (const Status status = model->set_weights(weighing->options); !status)
    return complain("--weights", status, ExitCode::usage);

  const Result<TopologyCounts> counts = count_topology(*loaded->character);
  if (!counts) return complain(place, counts.error(), ExitCode::internal_error);
  TearRun run{request, *loaded, std::move(*model), *weighing, *counts, *counts};
  if (const ExitCode code = play_operations(*operations, run, progress); code != ExitCode::ok)
    return code;
  progress.begin_step(operations->size() + 2, "writing");
  if (const ExitCode code = choose_influences(run); code != ExitCode::ok) return code;
  const Result<Json> json = report_json(run);
  if (!json) return complain(request.output.string(), json.error(), ExitCode::internal_error);
  const std::string report = dump(*json);
  if (const ExitCode code = write_files(run, report); code != ExitCode::ok) return code;
  run.has_findings |= run.current.non_manifold_edges > run.source.non_manifold_edges ||
                      run.current.degenerate_triangles > run.source.degenerate_triangles;
  if (request.picture) run.has_findings |= !draw_picture(*loaded, run.model, *request.picture);
  if (!request.report) std::fputs(report.c_str(), stdout);
  if (run.certified)
    std::fputs(certificate_line(*run.certified, *request.maximum_error).c_str(), stderr);
  return run.has_findings ? ExitCode::findings : ExitCode::ok;
}

}  // namespace sunder::tools
