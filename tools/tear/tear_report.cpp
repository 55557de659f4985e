#include "tools/tear/tear_report.h"

#include <algorithm>
#include <utility>

#include "tools/model/model_json.h"
#include "tools/tear/blood_of_run.h"
#include "tools/tear/open_lips_of_run.h"
#include "tools/tear/weight_report.h"
#include "tools/tear/wound_picture.h"
#include "tools/written_weights/certified_report.h"
#include "tools/written_weights/written_influences.h"

namespace sunder::tools {
namespace {

Json weighing_json(const Weighing& weighing) {
  Json json = {{"policy", weight_policy_name(weighing.options.policy)},
               {"influences", weighing.options.maximum_influences},
               {"refit_over", nullptr}};
  if (weighing.refit) json["refit_over"] = refit_over_text(*weighing.refit);
  return json;
}

/// Measures the weights of the model, and the weights in the file if they differ.
Result<Json> weight_errors_of(TornModel& model, const std::shared_ptr<const Character>& source) {
  const Result<WeightSample> sample = choose_sample(model);
  if (!sample) return sample.error();
  const auto poses = poses_to_measure(model, source, *sample);
  if (!poses) return poses.error();
  Result<Json> errors = weight_errors_json(model, *poses, *sample);
  if (!errors) return errors;
  Result<Json> as_written = written_weight_errors_json(model, *poses, *sample);
  if (!as_written) return as_written;
  if (as_written->is_null()) return errors;
  (*errors)["as_written"] = std::move(*as_written);
  (*errors)["note"] =
      "a GLB cannot hold the positions per influence of the policy 'exact': there those points are "
      "barycentric";
  return errors;
}

/// How the influences are written, and what that changes.
Json influences_written_json(const TearRun& run) {
  if (run.certified)
    return {{"maximum", "all"},
            {"format", "certified"},
            {"certificate",
             certificate_json(*run.certified, run.model.character(), *run.request.maximum_error)}};
  return to_json(run.pruning, run.request.save);
}

/// Influences of the vertex with the most, of the meshes that are written.
std::uint32_t most_written(const TearRun& run) {
  if (!run.certified) return run.pruning.most;
  std::uint32_t most = 0;
  for (const CertifiedMesh& chosen : run.certified->meshes) {
    const SkinWeights& weights = run.certified->character.meshes[chosen.mesh].weights;
    for (std::uint32_t v = 0; v < weights.vertex_count(); ++v)
      most = std::max(most, static_cast<std::uint32_t>(weights.of(v).size()));
  }
  return most;
}

}  // namespace

Result<Json> report_json(TearRun& run) {
  const TearRequest& request = run.request;
  const Json result = result_json(run.model, run.source, run.result);
  Json json = {{"sunder_report", 1}, {"model", request.model.string()}};
  json["output"] = request.output ? Json(request.output->string()) : Json();
  json["loading"] = to_json(run.loaded.report);
  json["operations"] = std::move(run.reports);
  if (run.robot) json["robot"] = robot_tear_json(*request.robot, *run.robot);
  json["weights"] = weighing_json(run.weighing);
  if (request.weight_errors) {
    Result<Json> weight_errors = weight_errors_of(run.model, run.loaded.character);
    if (!weight_errors) return weight_errors;
    json["weight_errors"] = std::move(*weight_errors);
  }
  json["influences_written_max"] = most_written(run);
  json["influences_written"] = influences_written_json(run);
  if (run.opening) json["open"] = open_lips_json(run);
  if (run.blood) json["blood"] = blood_json(run);
  if (run.wounds) json["wound_mask"] = wounds_json(run);
  json["result"] = result;
  return json;
}

}  // namespace sunder::tools
