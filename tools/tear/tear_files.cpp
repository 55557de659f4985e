#include "tools/tear/tear_files.h"

#include <sunder/tear/torn_weights.h>

#include <optional>
#include <utility>
#include <vector>

#include "tools/messages/output_file.h"
#include "tools/messages/overwriting.h"
#include "tools/messages/text_file.h"
#include "tools/model/model_output.h"
#include "tools/tear/blood_of_run.h"
#include "tools/tear/flesh_materials.h"
#include "tools/tear/open_lips_of_run.h"
#include "tools/written_weights/place_bound.h"

namespace sunder::tools {
namespace {

/// A text that is written before the model and renamed after it, so that a failure leaves neither.
class TextBesideModel {
 public:
  /// Does nothing without a file.
  TextBesideModel(const std::optional<std::filesystem::path>& file, const std::string& text) {
    if (file) staged_.emplace(*file, bytes_of(text));
  }

  [[nodiscard]] Status status() const { return staged_ ? staged_->status() : Status(); }
  [[nodiscard]] Status commit() { return staged_ ? staged_->commit() : Status(); }

 private:
  std::optional<StagedFile> staged_;
};

/// The files that outputs must not overwrite; none with --force.
std::vector<NamedFile> inputs_of(const TearRequest& request) {
  std::vector<NamedFile> inputs = {{"MODEL", request.model}};
  if (!request.operations.empty()) inputs.push_back({"--ops", request.operations});
  if (request.robot) {
    inputs.push_back({"--robot", request.robot->robot});
    inputs.push_back({"--trajectory", request.robot->trajectory});
  }
  for (const TissueField& field : request.tissue_fields)
    if (!field.image.empty()) inputs.push_back({"--tissue-field", field.image});
  if (request.force) inputs.clear();
  return inputs;
}

std::vector<NamedFile> outputs_of(const TearRequest& request) {
  std::vector<NamedFile> outputs;
  if (request.output) outputs.push_back({"--output", *request.output});
  if (request.report && !reports_to_stdout(request))
    outputs.push_back({"--report", *request.report});
  if (request.log) outputs.push_back({"--save-log", *request.log});
  if (request.picture) outputs.push_back({"--picture", *request.picture});
  if (request.wound_mask) outputs.push_back({"--wound-mask", *request.wound_mask});
  for (const MaskChannel channel : request.wound_mask_channels)
    outputs.push_back({"--wound-mask-channels", channel_file(*request.wound_mask, channel)});
  return outputs;
}

/// What the file tells of its vertices.
ExitCode add_origins(const TearRun& run, SaveOptions& save) {
  // Positions that gape and painted materials are not those of the source, and USD has no such
  // record.
  const TearRequest& request = run.request;
  if (request.without_origins || request.open == OpenLips::baked || request.blood ||
      is_usd(*request.output))
    return ExitCode::ok;
  const std::string place = run.request.model.string();
  Result<std::vector<MeshOrigins>> origins = vertex_origins(run.model);
  if (!origins) return complain(place, origins.error(), ExitCode::internal_error);
  const Character& written = run.certified ? run.certified->character : run.model.character();
  const auto stored = stored_weights(written, run.loaded, *origins, save);
  if (!stored) return complain(place, stored.error(), ExitCode::internal_error);
  const auto bound = bound_places(run.model.character(), *origins, *stored);
  if (!bound) return complain(place, bound.error(), ExitCode::internal_error);
  save.place_bound = *bound;
  save.origins = std::move(*origins);
  if (run.certified) save.certified_bound = run.certified->maximum;
  return ExitCode::ok;
}

ExitCode check_overwriting(const TearRequest& request, const std::vector<NamedFile>& outputs) {
  const std::string fault = overwriting(inputs_of(request), outputs, "; --force allows it");
  if (fault.empty()) return ExitCode::ok;
  print_error("sunder: " + fault);
  return ExitCode::usage;
}

}  // namespace

bool reports_to_stdout(const TearRequest& request) {
  return request.report && *request.report == "-";
}

ExitCode check_outputs(const TearRequest& request) {
  const std::vector<NamedFile> outputs = outputs_of(request);
  if (const ExitCode code = check_overwriting(request, outputs); code != ExitCode::ok) return code;
  const std::string fault = request.dry_run ? std::string() : impossible_output(outputs);
  if (fault.empty()) return ExitCode::ok;
  print_error("sunder: " + fault);
  return ExitCode::unreadable_input;
}

ExitCode check_piece_files(const TearRun& run) {
  const TearRequest& request = run.request;
  if (request.dry_run || !run.pieces) return ExitCode::ok;
  std::vector<NamedFile> outputs = outputs_of(request);
  for (const std::string& file : run.pieces->files()) outputs.push_back({"--pieces", file});
  return check_overwriting(request, outputs);
}

ExitCode write_pieces(TearRun& run) {
  const TearRequest& request = run.request;
  if (request.dry_run || !run.pieces) return ExitCode::ok;
  const Result<FleshMaterials> flesh = FleshMaterials::create(run);
  if (!flesh) return complain(*request.pieces, flesh.error(), ExitCode::internal_error);
  SaveOptions save = request.save;
  save.materials = flesh->appended();
  save.painted = painted_materials(run);
  const std::uint32_t first_painted = flesh->first_painted(save.materials.size());
  const auto with_flesh = [&](const DetachedPiece& piece) {
    return with_blood(run, first_painted, piece, flesh->with_flesh(piece));
  };
  const ExitCode code =
      run.pieces->write(run.loaded, save, with_flesh, run.messages, run.piece_files);
  if (code == ExitCode::ok && run.piece_files.empty())
    run.messages.warn(
        "--pieces: no piece was written; --sever takes off what it severs, and so does {\"op\": "
        "\"detach\"} of --ops");
  return code;
}

ExitCode write_files(const TearRun& run, const std::string& report, const std::string& log) {
  const TearRequest& request = run.request;
  if (request.dry_run || !request.output) return ExitCode::ok;
  const bool has_report_file = request.report && !reports_to_stdout(request);
  TextBesideModel report_file(has_report_file ? request.report : std::nullopt, report);
  if (const Status status = report_file.status(); !status)
    return complain(request.report->string(), status, ExitCode::unreadable_input);
  TextBesideModel log_file(request.log, log);
  if (const Status status = log_file.status(); !status)
    return complain(request.log->string(), status, ExitCode::unreadable_input);
  SaveOptions save = request.save;
  if (run.certified) {
    save.maximum_influences = kAllInfluences;
    save.weights_of_mesh = run.certified->formats;
  }
  const Result<WrittenModel> written = written_model(run);
  if (!written)
    return complain(request.output->string(), written.error(), ExitCode::internal_error);
  save.materials = written->materials;
  save.painted = painted_materials(run);
  if (const ExitCode code = add_origins(run, save); code != ExitCode::ok) return code;
  if (const Status status =
          write_changed(*request.output, *written->character, run.loaded, save, run.messages);
      !status)
    return complain(request.output->string(), status, ExitCode::internal_error);
  if (const Status status = log_file.commit(); !status)
    return complain(request.log->string(), status, ExitCode::unreadable_input);
  if (const Status status = report_file.commit(); !status)
    return complain(request.report->string(), status, ExitCode::unreadable_input);
  return ExitCode::ok;
}

}  // namespace sunder::tools
