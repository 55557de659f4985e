#include <sunder/io/character_file.h>
#include <sunder/io/operation_log.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/internal/find_named.h"
#include "tools/messages/output_file.h"
#include "tools/messages/printed.h"
#include "tools/messages/progress_bar.h"
#include "tools/messages/written_file.h"
#include "tools/model/coupled_refits.h"
#include "tools/model/load_notes.h"
#include "tools/model/model_check.h"
#include "tools/model/model_output.h"
#include "tools/model/named_material.h"
#include "tools/model/named_poses.h"
#include "tools/model/robot_joints.h"
#include "tools/picture/torn_picture.h"
#include "tools/tear/blood_of_run.h"
#include "tools/tear/open_lips_of_run.h"
#include "tools/tear/refit.h"
#include "tools/tear/tear_files.h"
#include "tools/tear/tear_play.h"
#include "tools/tear/tear_report.h"
#include "tools/tear/tear_run.h"
#include "tools/tear/tear_summary.h"
#include "tools/tear/validation_notes.h"
#include "tools/tear/wound_picture.h"
#include "tools/value_of.h"
#include "tools/verbs.h"
#include "tools/written_weights/certified_report.h"

namespace sunder::tools {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

Result<Weighing> choose_weighing(const TearRequest& request,
                                 const std::shared_ptr<const Character>& character) {
  Weighing weighing;
  if (!request.weights) return weighing;
  weighing.options.policy = *request.weights;
  if (*request.weights != WeightPolicy::exact && limits_influences(request.save))
    weighing.options.maximum_influences = request.save.maximum_influences;
  if (*request.weights != WeightPolicy::refit) return weighing;
  if (request.refit_over)
    for (const RefitImportance::OfClip& of : request.refit_over->importance.of_clip)
      if (!find_clip(*character, of.clip))
        return Status::failure(StatusCode::not_found, kNone, "no clip is named '%.100s'",
                               of.clip.c_str());
  auto refit = choose_refit(*character, request.refit_over);
  if (!refit) return refit.error();
  weighing.refit = std::move(*refit);
  if (!weighing.refit) return weighing;
  weighing.refit->bound = request.refit_bound;
  const std::optional<std::filesystem::path> robot =
      is_urdf(request.model) ? std::optional(request.model) : request.robot_limits;
  if (robot && weighing.refit->poses.range_of_motion)
    if (const Status status = limit_range_of_motion(*robot, *character, *weighing.refit); !status)
      return status;
  return weighing;
}

/// @return false if there is no picture, which is reported.
bool draw_picture(const TearRun& run, const std::filesystem::path& png) {
  const TornModel& model = run.model;
  const std::optional<PosedRobot> robot =
      run.robot ? std::optional(posed_robot(*run.robot)) : std::nullopt;
  const std::vector<Operation> history = value_of(model.history());
  Status status;
  if (history.empty())
    status = Status::failure(StatusCode::empty_input, kNone,
                             "the log has no operation that could be drawn");
  else
    status = draw_torn(run.loaded, history, png, run.messages, run.budget,
                       robot ? &*robot : nullptr, run.tissue);
  if (status) run.messages.say(written(png));
  if (!status) (void)complain(png.string(), status, ExitCode::findings);
  return static_cast<bool>(status);
}

/// With --max-error, chooses what is written of the torn model's weights; without it, measures what
/// writing them drops.
/// @return ok, or the exit code of the failure, which was reported.
ExitCode choose_influences(TearRun& run) {
  const std::optional<MaximumError>& wanted = run.request.maximum_error;
  if (!wanted) {
    const Result<PruningLoss> loss = measure_pruning(run.model, run.loaded, run.request.save);
    if (!loss)
      return complain(run.request.model.string(), loss.error(),
                      // An operation has named a material that the file does not have.
                      loss.error().code() == StatusCode::index_out_of_range
                          ? ExitCode::usage
                          : ExitCode::internal_error);
    run.pruning = *loss;
    return ExitCode::ok;
  }
  Result<CertifiedWeights> certified = certify_weights(run.model.character(), run.loaded, *wanted);
  if (!certified)
    return complain("--max-error, --limits " + wanted->limits, certified.error(), ExitCode::usage);
  run.certified = std::move(*certified);
  return ExitCode::ok;
}

/// Pieces are written as the model is.
std::string ending_of_pieces(const TearRequest& request) {
  const bool is_any_usd = request.output && is_usd(*request.output);
  return is_any_usd ? request.output->extension().string() : ".glb";
}

/// Warns of options that do not fit together or the source.
void warn_of_options(const TearRequest& request, const Character& source,
                     const Messages& messages) {
  const auto warn_of_name = [&](const char* option, const auto& file, const char* ending) {
    const std::string fault = file ? other_ending({option, *file}, ending) : std::string();
    if (!fault.empty()) messages.warn(fault);
  };
  if (request.output && !is_usd(*request.output)) warn_of_name("--output", request.output, "glb");
  warn_of_name("--picture", request.picture, "png");
  warn_of_name("--wound-mask", request.wound_mask, "png");
  if (!limits_influences(request.save)) return;
  const std::uint32_t most = check_model(source).most_influences;
  if (request.save.maximum_influences > most)
    messages.warn(
        printed("--influences %u: the vertices of %s have at most %u; only new vertices "
                "may get more",
                request.save.maximum_influences, request.model.c_str(), most));
}

/// Counts the topology at the end, and compares the faults with those of the source.
Status count_result(TearRun& run) {
  const Result<TopologyCounts> counts = count_topology(run.model.character());
  if (!counts) return counts.error();
  run.result = *counts;
  run.has_findings |= run.result.non_manifold_edges > run.source.non_manifold_edges ||
                      run.result.degenerate_triangles > run.source.degenerate_triangles;
  return {};
}

/// Writes the files and the pieces. The command is not ended meanwhile.
/// @return ok, or the exit code of the failure, which was reported.
ExitCode write_all(TearRun& run, const std::string& report, const std::string& log) {
  const Budget::Writing writing(run.budget);
  const auto begin = Clock::now();
  if (const ExitCode code = check_piece_files(run); code != ExitCode::ok) return code;
  if (const ExitCode code = write_files(run, report, log); code != ExitCode::ok) return code;
  if (const ExitCode code = write_pieces(run); code != ExitCode::ok) return code;
  run.times.saving = seconds_since(begin);
  return ExitCode::ok;
}

/// Writes the files and the picture, and prints the report or the summary.
/// @return ok, or the exit code of the failure, which was reported.
ExitCode finish(TearRun& run, Clock::time_point begin) {
  const TearRequest& request = run.request;
  if (const Status status = count_result(run); !status)
    return complain(request.model.string(), status, ExitCode::internal_error);
  if (const ExitCode code = choose_influences(run); code != ExitCode::ok) return code;
  if (const ExitCode code = open_lips_of_run(run); code != ExitCode::ok) return code;
  if (const ExitCode code = lay_blood_of_run(run); code != ExitCode::ok) return code;
  if (const ExitCode code = draw_wounds_of_run(run); code != ExitCode::ok) return code;
  std::string report;
  if (request.report) {
    const Result<Json> json = report_json(run);
    if (!json) return complain(request.model.string(), json.error(), ExitCode::internal_error);
    report = dump(*json);
  }
  Result<std::string> log = std::string();
  if (request.log) log = format_operations(value_of(run.model.history()));
  if (!log) return complain(request.log->string(), log.error(), ExitCode::usage);
  if (const ExitCode code = write_all(run, report, *log); code != ExitCode::ok) return code;
  if (const ExitCode code = write_wounds_of_run(run); code != ExitCode::ok) return code;
  if (request.picture && !request.dry_run) {
    run.budget.begin(request.picture->string());
    run.budget.allow_each(2);
    run.has_picture = draw_picture(run, *request.picture);
    run.has_findings |= !run.has_picture;
  }
  run.budget.end();
  if (!request.dry_run)
    for (const std::string& note : validation_notes(run)) run.messages.say(note);
  if (run.certified) run.messages.say(certificate_line(*run.certified, *request.maximum_error));
  run.messages.detail(times_line(run.times, seconds_since(begin)));
  if (reports_to_stdout(request))
    print_text(report);
  else if (!request.report && !run.messages.is_quiet())
    print(tear_summary(run));
  return run.has_findings ? ExitCode::findings : ExitCode::ok;
}

/// Reads the operations of the log, then those of the command line.
/// @return ok, or the exit code of the failure, which was reported.
ExitCode read_operations(const TearRequest& request, const LoadedCharacter& loaded,
                         std::vector<WantedOperation>& wanted) {
  if (!request.operations.empty()) {
    const std::string file = request.operations.string();
    auto logged = load_aimed_operations(request.operations, loaded.character.get());
    if (!logged) return complain(file, logged.error(), ExitCode::usage);
    if (const Status status = provide_coupled_refits(*logged); !status)
      return complain(file, status, ExitCode::usage);
    for (LoggedOperation& operation : *logged) {
      const std::string place = "/operations/" + std::to_string(wanted.size());
      if (const Status status = check_material(operation, loaded.source.get()); !status)
        return complain(file + ": " + place, status, ExitCode::usage);
      wanted.push_back({std::move(operation), place, file});
    }
  }
  for (TearRequest::Aimed aimed : request.aimed) {
    if (!aimed.material.empty()) {
      const Result<std::uint32_t> material = find_material(*loaded.character, aimed.material);
      if (!material) return complain(aimed.option, material.error(), ExitCode::usage);
      set_material(aimed.operation, *material);
    }
    if (const Status status = check_material(aimed.operation, loaded.source.get()); !status)
      return complain(aimed.option, status, ExitCode::usage);
    wanted.push_back({aimed.operation, aimed.option, {}, aimed});
  }
  return ExitCode::ok;
}

void add_closings(const TearRequest& request, std::vector<WantedOperation>& wanted) {
  for (const TearRequest::Closing& closing : request.closings)
    wanted.push_back({closing.operation, closing.option, {}});
}

/// With --robot, adds the tear of its blade.
/// @return ok, or the exit code of the failure, which was reported.
ExitCode add_robot_tear(TearRun& run, std::vector<WantedOperation>& operations) {
  if (!run.request.robot) return ExitCode::ok;
  run.robot.emplace();
  const ExitCode code = make_robot_tear(*run.request.robot, run.request.reading,
                                        *run.loaded.character, run.messages, *run.robot);
  if (code != ExitCode::ok) return code;
  run.has_findings |= !run.robot->warnings.empty();
  operations.push_back({Operation(run.robot->tear), "--robot", {}});
  return code;
}

}  // namespace

ExitCode run_tear(const TearRequest& request) {
  const auto begin = Clock::now();
  const Messages messages(request.verbosity);
  Budget budget(request.budget, request.model.string());
  if (const ExitCode code = check_outputs(request); code != ExitCode::ok) return code;
  const std::string place = request.model.string();
  LoadOptions load = load_options(request.reading);
  load.keep_stored_influences = request.maximum_error.has_value();
  const Result<LoadedCharacter> loaded = [&] {
    ProgressBar reading(1);
    reading.begin_step(0, "reading");
    return load_character(request.model, load);
  }();
  if (!loaded) return complain(place, loaded.error(), ExitCode::unreadable_input);
  const double loading = seconds_since(begin);
  warn_of_repairs(place, loaded->report, messages);
  warn_of_options(request, *loaded->character, messages);
  std::vector<WantedOperation> operations;
  if (const ExitCode code = read_operations(request, *loaded, operations); code != ExitCode::ok)
    return code;
  ProgressBar progress(operations.size() + 3);
  Result<TornModel> model = TornModel::create(loaded->character, budget.capacity());
  if (!model) return complain(place, model.error(), ExitCode::internal_error);
  const Result<Weighing> weighing = choose_weighing(request, loaded->character);
  if (!weighing)
    return complain(
        place + ": --refit-over", weighing.error(), ExitCode::usage,
        request.refit_over ? advice_on_names(*request.refit_over, *loaded->character) : "");
  if (const Status status = model->set_weights(weighing->options); !status)
    return complain("--weights", status, ExitCode::usage);

  const Result<TopologyCounts> counts = count_topology(*loaded->character);
  if (!counts) return complain(place, counts.error(), ExitCode::internal_error);
  TearRun run{request,
              messages,
              budget,
              *loaded,
              std::move(*model),
              *weighing,
              PosedSource(loaded->character),
              *counts,
              *counts};
  run.times.loading = loading;
  if (request.pieces)
    run.pieces.emplace(request.pieces_are_animated ? PieceMotion::animated : PieceMotion::frozen,
                       *request.pieces, ending_of_pieces(request));
  run.has_findings = has_losses(loaded->report);
  if (const ExitCode code = author_tissue_of_run(run); code != ExitCode::ok) return code;
  if (const ExitCode code = add_robot_tear(run, operations); code != ExitCode::ok) return code;
  add_closings(request, operations);
  if (const ExitCode code = play_operations(operations, run, progress); code != ExitCode::ok)
    return code;
  progress.begin_step(operations.size() + 2, "writing");
  return finish(run, begin);
}

}  // namespace sunder::tools
