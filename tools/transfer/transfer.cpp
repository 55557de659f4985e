#include <sunder/io/character_file.h>
#include <sunder/validation/transfer.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "tools/messages/json_file.h"
#include "tools/messages/lines.h"
#include "tools/messages/messages.h"
#include "tools/messages/overwriting.h"
#include "tools/messages/printed.h"
#include "tools/messages/text_file.h"
#include "tools/model/bone_names.h"
#include "tools/model/load_notes.h"
#include "tools/model/model_output.h"
#include "tools/model/name_advice.h"
#include "tools/transfer/copy_clips.h"
#include "tools/transfer/place_question.h"
#include "tools/transfer/transfer_report.h"
#include "tools/verbs.h"
#include "tools/written_weights/certified_report.h"
#include "tools/written_weights/certified_weights.h"

namespace sunder::tools {
namespace {

constexpr float kLocked = 0.5f;
/// Below this share of matches the models hardly stand where they should.
constexpr double kAskForPlace = 0.2;

/// Bones of the source like one that --bones names in vain.
std::string advice_on_bones(const TransferOptions& options, const Character& source) {
  std::vector<std::string> names;
  for (const Bone& bone : source.skeleton.bones) names.push_back(bone.name);
  for (const std::string& wanted : options.bones)
    if (std::ranges::find(names, wanted) == names.end()) return name_advice(wanted, "bones", names);
  return {};
}

/// The first output that would overwrite an input or another output; empty if there is none.
std::string overwriting_output(const TransferRequest& request) {
  std::vector<NamedFile> inputs = {{"SOURCE", request.source}, {"TARGET", request.target}}, outputs;
  if (!request.options.dry_run) outputs.push_back({"--output", request.output});
  if (request.report) outputs.push_back({"--report", *request.report});
  if (request.bone_names) inputs.push_back({"--bone-names", *request.bone_names});
  if (request.vertices) inputs.push_back({"--vertices", *request.vertices});
  return overwriting(inputs, outputs);
}

std::vector<std::vector<bool>> mask(const Character& character, bool value) {
  std::vector<std::vector<bool>> mask;
  for (const Mesh& mesh : character.meshes) mask.emplace_back(mesh.vertex_count(), value);
  return mask;
}

/// Locks all vertices but those listed, as {"mesh": [vertex, …]}.
Status lock_others(const std::filesystem::path& file, const Character& target,
                   TransferOptions& options) {
  const Result<Json> lists = read_json_object(file);
  if (!lists) return lists.error();
  options.locked = mask(target, true);
  for (const auto& [name, vertices] : lists->items()) {
    const auto mesh = std::ranges::find(target.meshes, name, &Mesh::name);
    if (mesh == target.meshes.end())
      return Status::failure(StatusCode::not_found, kNone, "the target has no mesh '%.80s'",
                             name.c_str());
    auto& locked = options.locked[static_cast<std::size_t>(mesh - target.meshes.begin())];
    for (const Json& vertex : vertices) {
      if (!vertex.is_number_unsigned() || vertex.get<std::uint64_t>() >= locked.size())
        return Status::failure(StatusCode::index_out_of_range, kNone,
                               "mesh '%.80s': not a vertex below %zu", name.c_str(), locked.size());
      locked[vertex.get<std::size_t>()] = false;
    }
  }
  return {};
}

/// Locks the vertices with a value of at least 0.5 in an attribute.
Status lock_by_attribute(const std::string& name, const Character& target,
                         TransferOptions& options) {
  if (options.locked.empty()) options.locked = mask(target, false);
  bool is_known = false;
  for (std::size_t m = 0; m < target.meshes.size(); ++m)
    for (const CustomAttribute& attribute : target.meshes[m].custom_attributes) {
      if (attribute.name != name) continue;
      is_known = true;
      for (std::size_t v = 0; v < options.locked[m].size(); ++v)
        if (attribute.values[v * attribute.components] >= kLocked) options.locked[m][v] = true;
    }
  if (is_known) return {};
  return Status::failure(StatusCode::not_found, kNone, "no mesh of the target has '%.80s'",
                         name.c_str());
}

/// @return ok, or the exit code of the failure, which was reported.
ExitCode read_rules(const TransferRequest& request, const Character& target,
                    TransferOptions& options) {
  if (request.bone_names) {
    Result<std::vector<BoneNames>> names = read_bone_names(*request.bone_names);
    if (!names) return complain(request.bone_names->string(), names.error(), ExitCode::usage);
    options.bone_names = std::move(*names);
  }
  if (request.vertices)
    if (const Status status = lock_others(*request.vertices, target, options); !status)
      return complain(request.vertices->string(), status, ExitCode::usage);
  if (request.lock)
    if (const Status status = lock_by_attribute(*request.lock, target, options); !status)
      return complain("--lock", status, ExitCode::usage);
  return ExitCode::ok;
}

/// Writes the model and its report: both, or none.
/// @param certified  the weights to write, with --max-error.
ExitCode write_files(const TransferRequest& request, const LoadedCharacter& target,
                     const TransferResult& result,
                     const std::optional<CertifiedWeights>& certified) {
  std::optional<StagedFile> report;
  if (request.report) {
    Json json = transfer_json(request, result);
    if (certified)
      json["certificate"] = certificate_json(*certified, result.character, *request.maximum_error);
    report.emplace(*request.report, bytes_of(dump(json)));
    if (!report->status())
      return complain(request.report->string(), report->status(), ExitCode::unreadable_input);
  }
  SaveOptions save = request.save;
  save.maximum_influences = kAllInfluences;  // The transfer has limited them already.
  if (certified) save.weights_of_mesh = certified->formats;
  const Character& character = certified ? certified->character : result.character;
  if (!request.options.dry_run)
    if (const Status status =
            write_changed(request.output, character, target, save, Messages(Verbosity::normal));
        !status)
      return complain(request.output.string(), status, ExitCode::internal_error);
  if (report)
    if (const Status status = report->commit(); !status)
      return complain(request.report->string(), status, ExitCode::unreadable_input);
  return ExitCode::ok;
}

/// What to do about a transfer that failed.
std::string advice_on_failure(const Status& status, const TransferOptions& options,
                              const Character& source, const Character& target) {
  return status.text().starts_with("no vertex of the target matches")
             ? " " + question_of_place(source, target)
             : advice_on_bones(options, source);
}

/// Copies the source's clips if that is wanted. @return a line that says so, or offers it.
Result<std::string> offer_clips(const TransferRequest& request, const Character& source,
                                TransferResult& result) {
  if (source.clips.empty()) return std::string();
  if (!request.copies_clips)
    return printed(
        "  the source has %zu clips, which the target does not get; --clips writes them too",
        source.clips.size());
  const Result<std::size_t> count = copy_clips(source, result);
  if (!count) return count.error();
  return printed("  %zu of the source's %zu clips are written too", *count, source.clips.size());
}

}  // namespace

ExitCode run_transfer(const TransferRequest& request) {
  if (const std::string fault = overwriting_output(request); !fault.empty()) {
    print_error("sunder: " + fault);
    return ExitCode::usage;
  }
  Budget budget(request.budget, request.target.string());
  const Result<LoadedCharacter> source =
      load_character(request.source, load_options(request.reading));
  if (!source) return complain(request.source.string(), source.error(), ExitCode::unreadable_input);
  LoadOptions load = load_options(request.reading);
  load.keep_stored_influences = request.maximum_error.has_value();
  const Result<LoadedCharacter> target = load_character(request.target, load);
  if (!target) return complain(request.target.string(), target.error(), ExitCode::unreadable_input);
  const Messages messages(Verbosity::normal);
  warn_of_repairs(request.source.string(), source->report, messages);
  warn_of_repairs(request.target.string(), target->report, messages);
  TransferOptions options = request.options;
  if (const ExitCode code = read_rules(request, *target->character, options); code != ExitCode::ok)
    return code;
  Result<TransferResult> result = transfer_weights(*source->character, *target->character, options);
  if (!result)
    return complain(
        request.target.string(), result.error(), ExitCode::usage,
        advice_on_failure(result.error(), options, *source->character, *target->character));
  if (result->matched_share() < kAskForPlace)
    messages.warn(request.target.string() + ": " +
                  printed("only %.3g %% of the vertices match; ", 100 * result->matched_share()) +
                  question_of_place(*source->character, *target->character));
  const Result<std::string> clips = offer_clips(request, *source->character, *result);
  if (!clips) return complain("--clips", clips.error(), ExitCode::usage);
  std::optional<CertifiedWeights> certified;
  if (const std::optional<MaximumError>& wanted = request.maximum_error) {
    Result<CertifiedWeights> weights = certify_weights(result->character, *target, *wanted);
    if (!weights)
      return complain("--max-error, --limits " + wanted->limits, weights.error(), ExitCode::usage);
    certified = std::move(*weights);
  }
  budget.end();
  if (const ExitCode code = write_files(request, *target, *result, certified); code != ExitCode::ok)
    return code;
  Lines lines = transfer_table(request, *result);
  if (!clips->empty()) lines.add(*clips);
  if (certified) lines.add(certificate_line(*certified, *request.maximum_error));
  print(lines);
  const bool has_findings = has_losses(source->report) || has_losses(target->report) ||
                            std::ranges::any_of(result->findings, [](const Finding& finding) {
                              return finding.severity != Severity::note;
                            });
  return has_findings ? ExitCode::findings : ExitCode::ok;
}

}  // namespace sunder::tools
