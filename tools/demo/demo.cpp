#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>

#include <iterator>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "tools/demo/demo_pictures.h"
#include "tools/demo/demo_rig.h"
#include "tools/demo/demo_stroke.h"
#include "tools/messages/overwriting.h"
#include "tools/messages/progress_bar.h"
#include "tools/messages/text_file.h"
#include "tools/messages/written_file.h"
#include "tools/model/load_notes.h"
#include "tools/model/model_json.h"
#include "tools/model/posed_model.h"
#include "tools/tear/report.h"
#include "tools/tear/weight_report.h"
#include "tools/verbs.h"

namespace sunder::tools {
namespace {

/// The model and its source; an embedded model has no file to patch on saving.
struct DemoModel {
  LoadedCharacter loaded;
  bool is_embedded = false;
};

Result<DemoModel> get_model(const DemoRequest& request) {
  if (request.model) {
    Result<LoadedCharacter> loaded = load_character(*request.model);
    if (!loaded) return loaded.error();
    warn_of_repairs(request.model->string(), loaded->report, Messages(Verbosity::normal));
    return DemoModel{*loaded, false};
  }
  LoadedCharacter embedded;
  embedded.character = std::make_shared<const Character>(make_cactus());
  embedded.report.format = "embedded";
  embedded.report.space = "metres, y up";
  return DemoModel{embedded, true};
}

Status save(const std::filesystem::path& file, const Character& character, const DemoModel& model) {
  return model.is_embedded ? save_glb(file, character) : save_glb(file, character, model.loaded);
}

/// The tear as an operation log, to repeat it with `sunder tear`.
Json operations_json(const Character& character, const Stroke& stroke) {
  Json blades = Json::array();
  for (const Blade& blade : stroke)
    blades.push_back({{"base", vector_json(blade.base)}, {"tip", vector_json(blade.tip)}});
  Json pose = "rest";
  if (!character.clips.empty())
    pose = {{"clip", 0},
            {"time", kTearFraction * static_cast<double>(character.clips[0].duration)}};
  Json operation = {{"op", "tear"},
                    {"pose", std::move(pose)},
                    {"width", 0.0},
                    {"layers", "nearest"},
                    {"stroke", std::move(blades)}};
  return {{"sunder_operations", 1}, {"operations", Json::array({std::move(operation)})}};
}

struct TornDemo {
  DemoTear tear;
  OperationOutcome outcome;
};

Result<TornDemo> tear_mid_clip(const LoadedCharacter& loaded) {
  const std::shared_ptr<const Character>& character = loaded.character;
  const Result<ModelPose> pose = make_pose(*character, pose_at(*character, kTearFraction));
  if (!pose) return pose.error();
  const Result<std::vector<DeformedMesh>> posed = pose_model(*character, *pose);
  if (!posed) return posed.error();
  const Result<SurfaceKinds> kinds = SurfaceKinds::create(*character, loaded.source.get());
  if (!kinds) return kinds.error();
  const SeenStroke seen = choose_stroke(*character, *kinds, *posed);
  const TearOperation tear{*pose, seen.stroke, {}, {}};
  if (tear.stroke.empty())
    return Status::failure(StatusCode::empty_input, kNone,
                           "no visible surface is large enough for a stroke");

  Result<TornModel> model = TornModel::create(character);
  if (!model) return model.error();
  const Result<TopologyCounts> before = count_topology(*character);
  if (!before) return before.error();
  Result<OperationOutcome> outcome = play(tear, *model);
  if (!outcome) return outcome.error();
  if (const Status status = measure_weight_error(tear, *model, *outcome); !status) return status;
  const Result<TopologyCounts> after = count_topology(model->character());
  if (!after) return after.error();
  outcome->topology = TopologyChange{*before, *after};
  return TornDemo{DemoTear{character, std::move(*model), tear, seen.frame}, *outcome};
}

/// Writes the models, the report and the operation log.
/// @return ok, or the exit code of the failure, which was reported.
ExitCode write_results(const DemoRequest& request, const std::string& place, const DemoModel& model,
                       TornDemo& demo, Budget& budget) {
  const Character& character = *model.loaded.character;
  const Result<Json> weight_errors = weight_errors_by_policy_json(
      demo.tear.model, model.loaded.character, pose_at(character, kTearFraction));
  if (!weight_errors) return complain(place, weight_errors.error(), ExitCode::internal_error);
  const Budget::Writing writing(budget);
  const std::filesystem::path output = request.folder / "torn.glb";
  const std::filesystem::path cactus = request.folder / "cactus.glb";
  if (model.is_embedded)
    if (const Status status = save(cactus, character, model); !status)
      return complain(cactus.string(), status, ExitCode::internal_error);
  if (const Status status = save(output, demo.tear.model.character(), model); !status)
    return complain(output.string(), status, ExitCode::internal_error);
  const Json report = {
      {"sunder_report", 1},
      {"model", place},
      {"output", output.string()},
      {"loading", to_json(model.loaded.report)},
      {"operations", Json::array({to_json(demo.outcome, demo.tear.model.character())})},
      {"weight_errors", *weight_errors},
      {"result",
       result_json(demo.tear.model, demo.outcome.topology->before, demo.outcome.topology->after)}};
  const std::pair<const char*, Json> texts[] = {
      {"report.json", report},
      {"ops.json", operations_json(character, demo.tear.operation.stroke)}};
  for (const auto& [name, json] : texts)
    if (const Status status = write_text(request.folder / name, dump(json)); !status)
      return complain((request.folder / name).string(), status, ExitCode::unreadable_input);
  return ExitCode::ok;
}

ExitCode say_written(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) Messages(Verbosity::normal).say(written(folder / name));
  return ExitCode::ok;
}

}  // namespace

ExitCode run_demo(const DemoRequest& request) {
  const std::string place = request.model ? request.model->string() : "embedded cactus";
  if (request.model) {
    const std::string fault =
        overwriting({{"MODEL", *request.model}}, {{"--output", request.folder / "torn.glb"}});
    if (!fault.empty()) {
      print_error("sunder: " + fault);
      return ExitCode::usage;
    }
  }
  Budget budget(request.budget, place);
  ProgressBar progress(2 + kDemoSteps);
  progress.begin_step(0, "reading");
  const Result<DemoModel> model = get_model(request);
  if (!model) return complain(place, model.error(), ExitCode::unreadable_input);

  std::error_code error;
  std::filesystem::create_directories(request.folder, error);
  if (error) {
    print_error("sunder: " + request.folder.string() +
                ": cannot create this folder: " + error.message());
    return ExitCode::unreadable_input;
  }

  progress.begin_step(1, "tearing");
  Result<TornDemo> demo = tear_mid_clip(model->loaded);
  if (!demo) return complain(place, demo.error(), ExitCode::unreadable_input);
  if (const ExitCode code = write_results(request, place, *model, *demo, budget);
      code != ExitCode::ok)
    return code;
  if (demo->outcome.has_missed) {
    print_error("sunder: " + place + ": the stroke met no surface");
    return ExitCode::findings;
  }

  std::vector<std::string> names = {"torn.glb", "report.json", "ops.json"};
  if (model->is_embedded) names.insert(names.begin(), "cactus.glb");
  if (request.no_pictures) return say_written(request.folder, names);
  const Result<ModelLooks> looks = ModelLooks::create(model->loaded.source.get());
  if (!looks) return complain(place, looks.error(), ExitCode::internal_error);
  if (const std::string missing = looks->missing_textures(); !missing.empty())
    Messages(Verbosity::normal).warn(place + ": " + missing);
  budget.begin(place + ": pictures");
  budget.allow_each(1 + std::size(kDemoPictures));
  if (const Status status = draw_demo(demo->tear, *looks, request.folder, budget, 2, progress);
      !status) {
    (void)complain(request.folder.string() + ": pictures", status, ExitCode::findings);
    return ExitCode::findings;
  }
  for (const char* const name : kDemoPictures) names.push_back(std::string(name) + ".png");
  return say_written(request.folder, names);
}

}  // namespace sunder::tools
