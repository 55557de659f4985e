#include "tools/weight_report.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/history.h"
#include "tools/refit.h"
#include "tools/value_of.h"

namespace sunder::tools {
namespace {

constexpr std::size_t kMostPoses = 200;  ///< Per set, so that measuring stays short.

/// The stride that selects at most kMostPoses of `count` poses.
std::size_t step_through(std::size_t count) { return (count + kMostPoses - 1) / kMostPoses; }

bool is_finite(const ModelPose& pose) {
  return std::ranges::all_of(pose.model_from_bone,
                             [](const Affine3d& bone) { return bone.matrix().allFinite(); }) &&
         std::ranges::all_of(pose.morph_weights,
                             [](float weight) { return std::isfinite(weight); });
}

Status add_poses(std::shared_ptr<const Character> source, const PoseSetSpec& spec,
                 const char* fit_name, const char* held_out_name,
                 std::vector<MeasuredPoses>& sets) {
  const Result<PoseSet> set = PoseSet::create(std::move(source), spec);
  if (!set) return set.error().code() == StatusCode::limit_exceeded ? set.error() : Status();
  for (const auto& [role, name] : {std::pair(PoseSet::Role::fit, fit_name),
                                   std::pair(PoseSet::Role::held_out, held_out_name)}) {
    const std::size_t count = set->size(role);
    MeasuredPoses measured{name, {}};
    for (std::size_t i = 0; i < count; i += step_through(count)) {
      if (const Status status = set->compute(role, i, measured.poses.emplace_back()); !status)
        return status;
      if (!is_finite(measured.poses.back())) measured.poses.pop_back();
    }
    if (!measured.poses.empty()) sets.push_back(std::move(measured));
  }
  return {};
}

Json to_json(const WeightErrors::Statistics& statistics) {
  return {{"rms", statistics.rms},
          {"percentile95", statistics.percentile95},
          {"maximum", statistics.maximum}};
}

Json to_json(const WeightErrors& errors) {
  Json json = {{"points", errors.points.size()}, {"poses", errors.poses}};
  json.update(to_json(errors.metres));
  json["of_diagonal"] = to_json(errors.of_diagonal);
  json["of_edge"] = to_json(errors.of_edge);
  return json;
}

/// Measures with other weights, which are undone afterwards.
Result<Json> measure_as(const std::vector<WeightsOperation>& weights,
                        const std::vector<MeasuredPoses>& sets, TornModel& model) {
  Result<Json> errors = Json();
  std::size_t done = 0;
  for (; done < weights.size(); ++done)
    if (const auto weighed = model.reweigh(weights[done]); !weighed) {
      errors = weighed.error();
      break;
    }
  if (done == weights.size()) errors = weight_errors_json(model, sets);
  for (; done > 0; --done)
    if (const Status status = model.undo(); !status) return status;
  return errors;
}

}  // namespace

Result<std::vector<MeasuredPoses>> poses_to_measure(const TornModel& model,
                                                    std::shared_ptr<const Character> source) {
  std::vector<MeasuredPoses> sets;
  Result<std::vector<ModelPose>> of_history = poses_of_history(model);
  if (!of_history) return of_history.error();
  if (of_history->empty()) return sets;
  MeasuredPoses& operations = sets.emplace_back();
  operations.name = "operations";
  for (std::size_t i = 0; i < of_history->size(); i += step_through(of_history->size()))
    operations.poses.push_back(std::move((*of_history)[i]));
  if (const Status status = add_poses(source, PoseSetSpec{}, "clips", "clips_held_out", sets);
      !status)
    return status;
  PoseSetSpec motion;
  motion.clip_samples = 0;
  motion.range_of_motion = true;
  if (const Status status =
          add_poses(std::move(source), motion, "range_of_motion", "range_of_motion_held_out", sets);
      !status)
    return status;
  return sets;
}

Result<Json> weight_errors_json(const TornModel& model, const std::vector<MeasuredPoses>& sets) {
  Json json = Json::object();
  if (model.undo_count() == 0) return json;
  for (const MeasuredPoses& set : sets) {
    const Result<WeightErrors> errors = measure_weight_errors(model, 0, kNone, set.poses);
    if (!errors) return errors.error();
    json[set.name] = to_json(*errors);
  }
  return json;
}

Result<Json> written_weight_errors_json(TornModel& model, const std::vector<MeasuredPoses>& sets) {
  const std::vector<PointsOfOperation> points = points_of_history(value_of(model.history()));
  std::vector<WeightsOperation> as_written;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].are_there || points[i].weights.policy != WeightPolicy::exact) continue;
    WeightsOperation& operation = as_written.emplace_back();
    operation.first_operation = static_cast<std::uint32_t>(i);
    operation.operation_count = 1;
  }
  if (as_written.empty()) return Json();
  return measure_as(as_written, sets, model);
}

Result<Json> weight_errors_by_policy_json(TornModel& model, std::shared_ptr<const Character> source,
                                          const PoseSpec& pose) {
  Json json = Json::object();
  if (model.undo_count() == 0) return json;
  const auto sets = poses_to_measure(model, source);
  if (!sets) return sets.error();
  const auto refit = choose_refit(*source, {});
  if (!refit) return refit.error();
  for (const WeightPolicy policy : {WeightPolicy::barycentric, WeightPolicy::pose_exact,
                                    WeightPolicy::refit, WeightPolicy::exact}) {
    WeightsOperation operation;
    operation.weights.policy = policy;
    operation.pose = pose;
    if (policy == WeightPolicy::refit) {
      if (!*refit) continue;
      operation.refit = **refit;
    }
    Result<Json> errors = measure_as({operation}, *sets, model);
    if (!errors) return errors.error();
    json[weight_policy_name(policy)] = std::move(*errors);
  }
  return json;
}

}  // namespace sunder::tools
