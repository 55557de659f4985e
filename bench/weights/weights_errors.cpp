#include "bench/weights/weights_errors.h"

#include <sunder/skinning/skinned_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "weights/internal/bind_position.h"

namespace sunder::bench {
namespace {

template <class T>
T value_or_abort(Result<T> result) {
  if (!result) std::abort();
  return std::move(*result);
}

WeightReport reweigh(TornOnce& torn, const WeightOptions& options, const PoseSetSpec& poses) {
  WeightsOperation operation;
  operation.weights = options;
  operation.pose = torn.pose;
  operation.refit.poses = poses;
  return value_or_abort(torn.model.reweigh(operation));
}

void undo(TornOnce& torn) {
  if (!torn.model.undo()) std::abort();
}

/// One per point and pose, in metres.
void append_errors(const TornModel& model, std::span<const ModelPose> poses,
                   std::vector<double>& errors) {
  for (const ModelPose& pose : poses)
    for (const auto& point : value_or_abort(measure_weight_errors(model, 0, 1, {&pose, 1})).points)
      errors.push_back(point.maximum);
}

ErrorStatistics statistics_of(std::vector<double>& errors, double diagonal) {
  if (errors.empty()) return {};
  double sum = 0;
  for (const double error : errors) sum += error * error;
  std::sort(errors.begin(), errors.end());
  return {std::sqrt(sum / static_cast<double>(errors.size())) / diagonal,
          errors[(errors.size() - 1) * 95 / 100] / diagonal, errors.back() / diagonal};
}

PolicyErrors::OverPoses measure_over(WeightsModel& model, const WeightOptions& options,
                                     const Poses& poses) {
  std::vector<double> fit, held_out;
  for (TornOnce& torn : model.tears) {
    reweigh(torn, options, poses.spec);
    append_errors(torn.model, poses.fit, fit);
    append_errors(torn.model, poses.held_out, held_out);
    undo(torn);
  }
  return {statistics_of(fit, model.diagonal), statistics_of(held_out, model.diagonal)};
}

/// The largest error in the pose of the tear, without points for which solve_bind_position() has no
/// solution.
double largest_pop(const TornOnce& torn, bool is_pose_exact) {
  const Character& character = torn.model.character();
  const auto palettes = palettes_of(character, torn.pose);
  double largest = 0;
  for (const auto& point :
       value_or_abort(measure_weight_errors(torn.model, 0, 1, {&torn.pose, 1})).points) {
    const Mesh& mesh = character.meshes[point.mesh];
    const bool is_met = !is_pose_exact || solve_bind_position(mesh.weights.of(point.vertex),
                                                              Vec3d::Zero(), palettes[mesh.skin]);
    if (is_met) largest = std::max(largest, point.maximum);
  }
  return largest;
}

/// A mesh of a torn model, posed as in an engine.
struct Posed {
  const Mesh* mesh;
  SkinnedMesh skinned;
  BonePalette palette;
  std::vector<float> positions;
  PosedBuffer buffer;

  Posed(const Character& character, const Mesh& of, const InfluencePositions& exact)
      : mesh(&of),
        skinned(skin(character, of, exact)),
        palette(*BonePalette::create(character.skins[of.skin].bones.size(),
                                     character.rest_morph_weights.size())),
        positions(3 * std::size_t{of.vertex_count()}),
        buffer({of.vertex_count(), {positions.data()}, {}, {}}) {}

  static SkinnedMesh skin(const Character& character, const Mesh& mesh,
                          const InfluencePositions& exact) {
    VertexSource source = source_of(mesh);
    source.per_influence = &exact;
    return value_or_abort(SkinnedMesh::create(source, character.skins[mesh.skin].bones.size()));
  }

  void pose(const Character& character, const ModelPose& pose) {
    if (!palette.set(character.skins[mesh->skin], pose) || !skinned.deform(palette, buffer))
      std::abort();
  }
};

double largest_runtime_error(const WeightsModel& model, const TornOnce& torn,
                             std::span<const ModelPose> poses) {
  const Character& character = torn.model.character();
  std::set<std::uint32_t> torn_meshes;
  for (const TornPoint& point : torn.points) torn_meshes.insert(point.mesh);
  double largest = 0;
  for (const std::uint32_t mesh : torn_meshes) {
    const Mesh& of = character.meshes[mesh];
    Posed posed(character, of, torn.model.influence_positions(mesh));
    for (const ModelPose& pose : poses) {
      posed.pose(character, pose);
      const auto palettes = palettes_of(character, pose);
      for (const TornPoint& point : torn.points) {
        if (point.mesh != mesh) continue;
        const Vec3d belongs = point.posed(*model.character, palettes[of.skin], pose.morph_weights);
        const Vec3d stands = Eigen::Map<const Eigen::Vector3f>(posed.positions.data() +
                                                               3 * std::size_t{point.vertex})
                                 .cast<double>();
        largest = std::max(largest, (stands - belongs).norm());
      }
    }
  }
  return largest;
}

}  // namespace

PolicyErrors measure_policy(WeightsModel& model, const WeightOptions& options) {
  PolicyErrors errors;
  if (model.clips) errors.clips = measure_over(model, options, *model.clips);
  errors.range_of_motion = measure_over(model, options, model.range_of_motion);
  for (TornOnce& torn : model.tears) {
    errors.ill_conditioned += reweigh(torn, options, model.usual_poses().spec).ill_conditioned;
    errors.pop = std::max(
        errors.pop, largest_pop(torn, options.policy == WeightPolicy::pose_exact) / model.diagonal);
    undo(torn);
  }
  return errors;
}

double largest_runtime_error(WeightsModel& model) {
  double largest = 0;
  for (TornOnce& torn : model.tears) {
    reweigh(torn, {WeightPolicy::exact}, {});
    for (const Poses* poses : {model.clips ? &*model.clips : nullptr, &model.range_of_motion})
      if (poses != nullptr)
        for (const auto& some : {std::span(poses->fit), std::span(poses->held_out)})
          largest = std::max(largest, largest_runtime_error(model, torn, some));
    undo(torn);
  }
  return largest / model.diagonal;
}

}  // namespace sunder::bench
