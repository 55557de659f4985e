#include "tools/written_weights/written_influences.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/weights/influences.h>

#include <algorithm>
#include <vector>

#include "tools/model/history.h"

namespace sunder::tools {
namespace {

Vec3d morphed_position(const Mesh& mesh, std::uint32_t vertex, const ModelPose& pose) {
  Vec3d position = mesh.positions[vertex].cast<double>();
  for (std::size_t j = 0; j < mesh.morph_targets.size(); ++j)
    if (!mesh.morph_targets[j].position_deltas.empty())
      position += static_cast<double>(pose.morph_weights[mesh.first_morph_weight + j]) *
                  mesh.morph_targets[j].position_deltas[vertex].cast<double>();
  return position;
}

Status measure_mesh(const Mesh& mesh, const Skin& skin, const std::vector<ModelPose>& poses,
                    std::uint32_t maximum, PruningLoss& loss) {
  std::vector<std::vector<Affine3d>> palettes(poses.size(),
                                              std::vector<Affine3d>(skin.bones.size()));
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (const Status status = compute_palette(skin, poses[i], palettes[i]); !status) return status;
  std::vector<Influence> influences;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto all = mesh.weights.of(v);
    if (all.size() <= maximum) continue;
    influences.assign(all.begin(), all.end());
    if (!sort_influences(influences)) continue;  // Cannot fail: the model is valid.
    ++loss.vertices_pruned;
    loss.dropped_mass_max = std::max(loss.dropped_mass_max, dropped_mass(influences, maximum));
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Vec3d moved = pruning_displacement(morphed_position(mesh, v, poses[i]), influences,
                                               maximum, palettes[i]);
      loss.pruning_error_max = std::max(loss.pruning_error_max, moved.norm());
    }
  }
  return {};
}

}  // namespace

Result<PruningLoss> measure_pruning(const TornModel& model, std::uint32_t maximum) {
  PruningLoss loss;
  if (maximum == 0) return loss;
  Result<std::vector<ModelPose>> poses = poses_of_history(model);
  if (!poses) return poses.error();
  const Result<ModelPose> rest = make_pose(model.source(), RestPose());
  if (!rest) return rest.error();
  poses->push_back(*rest);
  const Character& character = model.character();
  for (std::size_t i = 0; i < character.meshes.size(); ++i) {
    const Mesh& mesh = character.meshes[i];
    if (mesh == model.source().meshes[i]) continue;
    if (const Status status = measure_mesh(mesh, character.skins[mesh.skin], *poses, maximum, loss);
        !status)
      return status;
  }
  return loss;
}

const char* weight_format_name(WeightFormat format) {
  switch (format) {
    case WeightFormat::float32: return "float";
    case WeightFormat::unorm16: return "u16";
    case WeightFormat::unorm8: return "u8";
  }
  return "float";
}

Json to_json(const PruningLoss& loss, const SaveOptions& options) {
  return {{"maximum", options.maximum_influences},
          {"format", weight_format_name(options.weights)},
          {"vertices_pruned", loss.vertices_pruned},
          {"dropped_mass_max", loss.dropped_mass_max},
          {"pruning_error_max", loss.pruning_error_max}};
}

}  // namespace sunder::tools
