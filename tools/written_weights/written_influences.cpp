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

/// Greatest displacement of the vertices of a mesh that lose influences.
Status measure_mesh(const Mesh& mesh, const Skin& skin, const std::vector<ModelPose>& poses,
                    std::uint32_t maximum, double& error) {
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
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Vec3d moved = pruning_displacement(morphed_position(mesh, v, poses[i]), influences,
                                               maximum, palettes[i]);
      error = std::max(error, moved.norm());
    }
  }
  return {};
}

/// The rest pose, those of the operations, and those of the clips that a refit would use.
Result<std::vector<ModelPose>> poses_to_compare(const TornModel& model,
                                                const LoadedCharacter& loaded) {
  Result<std::vector<ModelPose>> poses = poses_of_history(model);
  if (!poses) return poses;
  const Result<ModelPose> rest = make_pose(model.source(), RestPose());
  if (!rest) return rest.error();
  poses->push_back(*rest);
  if (loaded.character->clips.empty()) return poses;
  const Result<PoseSet> clips = PoseSet::create(loaded.character, {});
  if (!clips) return clips.error();
  for (std::size_t i = 0; i < clips->size(PoseSet::Role::fit); ++i) {
    poses->emplace_back();
    if (const Status status = clips->compute(PoseSet::Role::fit, i, poses->back()); !status)
      return status;
  }
  return poses;
}

}  // namespace

Result<PruningLoss> measure_pruning(const TornModel& model, const LoadedCharacter& loaded,
                                    const SaveOptions& options) {
  const Character& character = model.character();
  const auto written = written_influences(character, loaded, options);
  if (!written) return written.error();
  PruningLoss loss;
  for (const WrittenInfluences& mesh : *written) {
    loss.most = std::max(loss.most, mesh.most);
    loss.vertices_pruned += mesh.vertices_pruned;
    loss.dropped_mass_max = std::max(loss.dropped_mass_max, mesh.dropped_mass_max);
  }
  if (loss.vertices_pruned == 0) return loss;
  const Result<std::vector<ModelPose>> poses = poses_to_compare(model, loaded);
  if (!poses) return poses.error();
  for (const WrittenInfluences& of : *written) {
    if (of.vertices_pruned == 0) continue;
    const Mesh& mesh = character.meshes[of.mesh];
    if (const Status status = measure_mesh(mesh, character.skins[mesh.skin], *poses, of.maximum,
                                           loss.pruning_error_max);
        !status)
      return status;
  }
  return loss;
}

std::string influences_name(std::uint32_t maximum) {
  if (maximum == 0) return "source";
  return maximum == kAllInfluences ? "all" : std::to_string(maximum);
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
  return {{"maximum", influences_name(options.maximum_influences)},
          {"format", weight_format_name(options.weights)},
          {"vertices_pruned", loss.vertices_pruned},
          {"dropped_mass_max", loss.dropped_mass_max},
          {"pruning_error_max", loss.pruning_error_max}};
}

}  // namespace sunder::tools
