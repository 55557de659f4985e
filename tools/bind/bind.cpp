#include <sunder/binding/binding.h>
#include <sunder/io/character_file.h>
#include <sunder/io/robot_file.h>
#include <sunder/skinning/pose.h>

#include <optional>
#include <string>
#include <utility>

#include "tools/bind/bind_report.h"
#include "tools/messages/json_file.h"
#include "tools/messages/overwriting.h"
#include "tools/messages/text_file.h"
#include "tools/model/joint_values.h"
#include "tools/model/load_notes.h"
#include "tools/model/model_output.h"
#include "tools/model/pose_argument.h"
#include "tools/model/robot_joints.h"
#include "tools/verbs.h"

namespace sunder::tools {
namespace {

/// The first output that would overwrite an input or another output; empty if there is none.
std::string overwriting_output(const BindRequest& request) {
  std::vector<NamedFile> inputs = {{"MODEL", request.model}, {"--skeleton", request.skeleton}},
                         outputs = {{"--output", request.output}};
  if (request.map) inputs.push_back({"--map", *request.map});
  if (request.report) outputs.push_back({"--report", *request.report});
  return overwriting(inputs, outputs);
}

/// Reads {"bone of the model": "bone of the rig"}.
Result<std::vector<BonePair>> read_map(const std::filesystem::path& file) {
  const Result<Json> map = read_json_object(file);
  if (!map) return map.error();
  std::vector<BonePair> pairs;
  for (const auto& [model, rig] : map->items()) {
    if (!rig.is_string())
      return Status::failure(StatusCode::malformed_file, kNone,
                             "'%.80s': expected the name of a bone of the skeleton", model.c_str());
    pairs.push_back({model, rig.get<std::string>()});
  }
  return pairs;
}

/// Model, rig and map as read, and the place of the binding.
struct Inputs {
  LoadedCharacter model, rig;
  std::vector<BonePair> pairs;
  BindingPlace place;
};

/// @return ok, or the exit code of the failure, which was reported.
ExitCode find_pose(const BindRequest& request, Inputs& inputs) {
  if (!request.joints.empty()) {
    Result<ModelPose> pose = pose_of_joints(request.joints, request.skeleton);
    if (!pose) return complain("--joints", pose.error(), ExitCode::usage);
    inputs.place.rig_from_bone = std::move(pose->model_from_bone);
    return ExitCode::ok;
  }
  const Character& rig = *inputs.rig.character;
  const Result<PoseArgument> argument = parse_pose(request.pose, rig);
  if (!argument)
    return complain("--pose", argument.error(), ExitCode::usage, advice_on_pose(request.pose, rig));
  if (!argument->remark.empty()) Messages(Verbosity::normal).warn("--pose: " + argument->remark);
  Result<ModelPose> pose = make_pose(rig, argument->spec);
  if (!pose) return complain("--pose", pose.error(), ExitCode::usage);
  inputs.place.rig_from_bone = std::move(pose->model_from_bone);
  return ExitCode::ok;
}

/// @return as find_pose().
ExitCode find_place(const BindRequest& request, Inputs& inputs) {
  if (const ExitCode code = find_pose(request, inputs); code != ExitCode::ok) return code;
  if (request.place) inputs.place.rig_from_model = *request.place;
  if (!request.fit) return ExitCode::ok;
  const Result<Affine3d> fitted =
      fit_place(*inputs.model.character, *inputs.rig.character, inputs.pairs, inputs.place);
  if (!fitted) return complain("--fit", fitted.error(), ExitCode::usage);
  inputs.place.rig_from_model = *fitted;
  return ExitCode::ok;
}

/// A robot is a skeleton without any of its meshes too.
Result<LoadedCharacter> read_skeleton(const BindRequest& request) {
  const LoadOptions load = load_options(request.reading);
  Result<LoadedCharacter> rig = load_character(request.skeleton, load);
  if (rig || rig.error().code() != StatusCode::empty_input || !is_urdf(request.skeleton))
    return rig;
  Result<LoadedRobot> robot = load_robot(request.skeleton, robot_load_options(request.reading));
  if (!robot) return robot.error();
  return std::move(robot->model);
}

ExitCode read_inputs(const BindRequest& request, Inputs& inputs) {
  const LoadOptions load = load_options(request.reading);
  Result<LoadedCharacter> model = load_character(request.model, load);
  if (!model) return complain(request.model.string(), model.error(), ExitCode::unreadable_input);
  inputs.model = std::move(*model);
  Result<LoadedCharacter> rig = read_skeleton(request);
  if (!rig) return complain(request.skeleton.string(), rig.error(), ExitCode::unreadable_input);
  inputs.rig = std::move(*rig);
  const Messages messages(Verbosity::normal);
  warn_of_repairs(request.model.string(), inputs.model.report, messages);
  warn_of_repairs(request.skeleton.string(), inputs.rig.report, messages);
  if (request.map) {
    Result<std::vector<BonePair>> pairs = read_map(*request.map);
    if (!pairs) return complain(request.map->string(), pairs.error(), ExitCode::usage);
    inputs.pairs = std::move(*pairs);
  }
  return find_place(request, inputs);
}

/// The argument that a failed binding is to be blamed on: names come from the map or --bones.
std::string blamed(const BindRequest& request, const Status& failure) {
  if (failure.code() != StatusCode::not_found) return request.model.string();
  return request.map ? request.map->string() : "--bones";
}

Result<AnyBinding> bind_models(const BindRequest& request, const Inputs& inputs) {
  const Character &model = *inputs.model.character, &rig = *inputs.rig.character;
  if (request.map) {
    Result<MappedBinding> mapped =
        bind_by_mapping(model, rig, inputs.pairs, {inputs.place, request.refuse_unmapped});
    if (!mapped) return mapped.error();
    return AnyBinding(std::move(*mapped));
  }
  HeatOptions options = request.options;
  options.place = inputs.place;
  Result<HeatBinding> heated = bind_by_heat(model, rig, options);
  if (!heated) return heated.error();
  return AnyBinding(std::move(*heated));
}

/// Writes the model and its report: both, or none.
ExitCode write_files(const BindRequest& request, const Inputs& inputs, const AnyBinding& binding) {
  std::optional<StagedFile> report;
  if (request.report) {
    report.emplace(*request.report, bytes_of(dump(bind_json(request, binding, inputs.place))));
    if (!report->status())
      return complain(request.report->string(), report->status(), ExitCode::unreadable_input);
  }
  const Character& character = common(binding).character;
  const Status status = write_new(request.output, character, inputs.model.source, request.save,
                                  Messages(Verbosity::normal));
  if (!status) return complain(request.output.string(), status, ExitCode::internal_error);
  if (report)
    if (const Status committed = report->commit(); !committed)
      return complain(request.report->string(), committed, ExitCode::unreadable_input);
  return ExitCode::ok;
}

}  // namespace

ExitCode run_bind(const BindRequest& request) {
  if (const std::string fault = overwriting_output(request); !fault.empty()) {
    print_error("sunder: " + fault);
    return ExitCode::usage;
  }
  Budget budget(request.budget, request.model.string());
  Inputs inputs;
  if (const ExitCode code = read_inputs(request, inputs); code != ExitCode::ok) return code;
  const Result<AnyBinding> binding = bind_models(request, inputs);
  if (!binding) return complain(blamed(request, binding.error()), binding.error(), ExitCode::usage);
  budget.end();
  if (const ExitCode code = write_files(request, inputs, *binding); code != ExitCode::ok)
    return code;
  print(bind_table(*binding));
  const std::vector<std::string> warnings = bind_warnings(*binding);
  for (const std::string& warning : warnings) Messages(Verbosity::normal).warn(warning);
  const bool has_findings =
      !warnings.empty() || has_losses(inputs.model.report) || has_losses(inputs.rig.report);
  return has_findings ? ExitCode::findings : ExitCode::ok;
}

}  // namespace sunder::tools
