#include "tools/tear/weight_report.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/model/history.h"
#include "tools/tear/refit.h"
#include "tools/value_of.h"

namespace sunder::tools {
namespace {

constexpr std::size_t kMostPoints = 4'000;
constexpr std::size_t kMostPoses = 24, kLeastPoses = 2;  ///< Per set.
constexpr std::size_t kMostParts = 8;  ///< Of the history. Each takes O(vertices of the source).
constexpr std::size_t kLargeSource = 200'000;  ///< Vertices; one part for sources above it.

/// The stride that selects at most `most` of `count` poses.
std::size_t step_through(std::size_t count, std::size_t most) { return (count + most - 1) / most; }

std::size_t vertex_count(const Character& character) {
  std::size_t count = 0;
  for (const Mesh& mesh : character.meshes) count += mesh.vertex_count();
  return count;
}

/// Evenly spread parts of a history that have about kMostPoints points.
std::vector<WeightSample::Operations> spread_parts(std::size_t operations, std::size_t points,
                                                   std::size_t most_parts) {
  if (points <= kMostPoints || operations <= 1)
    return {{0, static_cast<std::uint32_t>(operations)}};
  const std::size_t parts = std::min(most_parts, operations);
  const std::size_t size =
      std::clamp<std::size_t>(kMostPoints * operations / (points * parts), 1, operations / parts);
  std::vector<WeightSample::Operations> spread;
  for (std::size_t i = 0; i < parts; ++i)
    spread.push_back(
        {static_cast<std::uint32_t>(parts == 1 ? 0 : i * (operations - size) / (parts - 1)),
         static_cast<std::uint32_t>(size)});
  return spread;
}

bool is_finite(const ModelPose& pose) {
  return std::ranges::all_of(pose.model_from_bone,
                             [](const Affine3d& bone) { return bone.matrix().allFinite(); }) &&
         std::ranges::all_of(pose.morph_weights,
                             [](float weight) { return std::isfinite(weight); });
}

Status add_poses(std::shared_ptr<const Character> source, const PoseSetSpec& spec,
                 std::pair<const char*, const char*> names, std::size_t most,
                 std::vector<MeasuredPoses>& sets) {
  const Result<PoseSet> set = PoseSet::create(std::move(source), spec);
  if (!set) return set.error().code() == StatusCode::limit_exceeded ? set.error() : Status();
  for (const auto& [role, name] : {std::pair(PoseSet::Role::fit, names.first),
                                   std::pair(PoseSet::Role::held_out, names.second)}) {
    const std::size_t count = set->size(role);
    MeasuredPoses measured{name, {}, count};
    for (std::size_t i = 0; i < count; i += step_through(count, most)) {
      if (const Status status = set->compute(role, i, measured.poses.emplace_back()); !status)
        return status;
      if (!is_finite(measured.poses.back())) measured.poses.pop_back();
    }
    if (!measured.poses.empty()) sets.push_back(std::move(measured));
  }
  return {};
}

/// Statistics of points: `rms` over all points and poses, the others of each point's maximum.
struct Statistics {
  std::vector<double> maxima;
  double squares = 0;

  void add(double rms, double maximum) {
    squares += rms * rms;
    maxima.push_back(maximum);
  }
  [[nodiscard]] Json json() {
    double rms = 0, percentile95 = 0, maximum = 0;
    if (!maxima.empty()) {
      rms = std::sqrt(squares / static_cast<double>(maxima.size()));
      std::ranges::sort(maxima);
      percentile95 = maxima[(maxima.size() - 1) * 95 / 100];
      maximum = maxima.back();
    }
    return {{"rms", rms}, {"percentile95", percentile95}, {"maximum", maximum}};
  }
};

/// The errors of a sample of points over one set of poses.
Result<Json> errors_json(const TornModel& model, const MeasuredPoses& set,
                         const WeightSample& sample) {
  Statistics metres, of_diagonal, of_edge;
  for (const WeightSample::Operations& part : sample.operations) {
    const Result<WeightErrors> errors =
        measure_weight_errors(model, part.first, part.count, set.poses);
    if (!errors) return errors.error();
    const double per_metre =
        errors->metres.maximum > 0 ? errors->of_diagonal.maximum / errors->metres.maximum : 0.0;
    for (const WeightErrors::OfPoint& of : errors->points) {
      metres.add(of.rms, of.maximum);
      of_diagonal.add(per_metre * of.rms, per_metre * of.maximum);
      const double per_edge = of.edge > 0 ? 1 / of.edge : 0.0;
      of_edge.add(per_edge * of.rms, per_edge * of.maximum);
    }
  }
  Json json = {{"points", metres.maxima.size()},
               {"points_of", sample.points_of},
               {"poses", set.poses.size()},
               {"poses_of", set.poses_of}};
  json.update(metres.json());
  json["of_diagonal"] = of_diagonal.json();
  json["of_edge"] = of_edge.json();
  return json;
}

/// Measures with other weights, which are undone afterwards.
Result<Json> measure_as(const std::vector<WeightsOperation>& weights,
                        const std::vector<MeasuredPoses>& sets, const WeightSample& sample,
                        TornModel& model) {
  Result<Json> errors = Json();
  std::size_t done = 0;
  for (; done < weights.size(); ++done)
    if (const auto weighed = model.reweigh(weights[done]); !weighed) {
      errors = weighed.error();
      break;
    }
  if (done == weights.size()) errors = weight_errors_json(model, sets, sample);
  for (; done > 0; --done)
    if (const Status status = model.undo(); !status) return status;
  return errors;
}

}  // namespace

Result<WeightSample> choose_sample(const TornModel& model) {
  WeightSample sample;
  if (model.undo_count() == 0) return sample;
  const Result<WeightErrors> all = measure_weight_errors(model, 0, kNone, {});
  if (!all) return all.error();
  sample.points_of = all->points.size();
  const std::size_t parts = vertex_count(model.source()) > kLargeSource ? 1 : kMostParts;
  sample.operations = spread_parts(model.undo_count(), sample.points_of, parts);
  std::size_t operations = 0;
  for (const WeightSample::Operations& part : sample.operations) operations += part.count;
  const std::size_t points =
      std::max<std::size_t>(1, sample.points_of * operations / model.undo_count());
  sample.most_poses = std::clamp(kMostPoses * kMostPoints / points, kLeastPoses, kMostPoses);
  return sample;
}

Result<std::vector<MeasuredPoses>> poses_to_measure(const TornModel& model,
                                                    const std::shared_ptr<const Character>& source,
                                                    const WeightSample& sample) {
  std::vector<MeasuredPoses> sets;
  if (sample.operations.empty()) return sets;
  Result<std::vector<ModelPose>> of_history = poses_of_history(model);
  if (!of_history) return of_history.error();
  if (of_history->empty()) return sets;
  const std::size_t most = sample.most_poses, count = of_history->size();
  MeasuredPoses& operations = sets.emplace_back(MeasuredPoses{"operations", {}, count});
  for (std::size_t i = 0; i < count; i += step_through(count, most))
    operations.poses.push_back(std::move((*of_history)[i]));
  if (const Status status =
          add_poses(source, PoseSetSpec{}, {"clips", "clips_held_out"}, most, sets);
      !status)
    return status;
  PoseSetSpec motion;
  motion.clip_samples = 0;
  motion.range_of_motion = true;
  if (const Status status =
          add_poses(source, motion, {"range_of_motion", "range_of_motion_held_out"}, most, sets);
      !status)
    return status;
  return sets;
}

Result<Json> weight_errors_json(const TornModel& model, const std::vector<MeasuredPoses>& sets,
                                const WeightSample& sample) {
  Json json = Json::object();
  for (const MeasuredPoses& set : sets) {
    Result<Json> errors = errors_json(model, set, sample);
    if (!errors) return errors;
    json[set.name] = std::move(*errors);
  }
  return json;
}

Result<Json> written_weight_errors_json(TornModel& model, const std::vector<MeasuredPoses>& sets,
                                        const WeightSample& sample) {
  const std::vector<PointsOfOperation> points = points_of_history(value_of(model.history()));
  std::vector<WeightsOperation> as_written;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].are_there || points[i].weights.policy != WeightPolicy::exact) continue;
    WeightsOperation& operation = as_written.emplace_back();
    operation.first_operation = static_cast<std::uint32_t>(i);
    operation.operation_count = 1;
  }
  if (as_written.empty()) return Json();
  return measure_as(as_written, sets, sample, model);
}

Result<Json> weight_errors_by_policy_json(TornModel& model, std::shared_ptr<const Character> source,
                                          const PoseSpec& pose) {
  Json json = Json::object();
  if (model.undo_count() == 0) return json;
  const Result<WeightSample> sample = choose_sample(model);
  if (!sample) return sample.error();
  const auto sets = poses_to_measure(model, source, *sample);
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
    Result<Json> errors = measure_as({operation}, *sets, *sample, model);
    if (!errors) return errors.error();
    json[weight_policy_name(policy)] = std::move(*errors);
  }
  return json;
}

}  // namespace sunder::tools
