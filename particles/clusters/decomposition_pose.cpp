#include "particles/clusters/decomposition_pose.h"

#include <sunder/skinning/deform.h>

namespace sunder::particles {

DecompositionPose::DecompositionPose(const Character& character, const ModelPose& pose)
    : palettes_(character.skins.size()), morph_weights_(pose.morph_weights) {
  std::vector<Affine3d> palette;
  for (std::size_t s = 0; s < character.skins.size(); ++s) {
    palette.resize(character.skins[s].bones.size());
    (void)compute_palette(character.skins[s], pose, std::span(palette));  // sizes were checked
    palettes_[s].resize(palette.size());
    for (std::size_t slot = 0; slot < palette.size(); ++slot)
      for (int c = 0; c < 4; ++c) {
        palettes_[s][slot][static_cast<std::size_t>(c)].setZero();
        palettes_[s][slot][static_cast<std::size_t>(c)].head<3>() =
            palette[slot].matrix().col(c).head<3>().cast<float>();
      }
  }
}

Vec3f DecompositionPose::place(const Mesh& mesh, Index vertex) const {
  Eigen::Vector3f bind = mesh.positions[vertex];
  for (std::size_t t = 0; t < mesh.morph_targets.size(); ++t)
    if (const auto& deltas = mesh.morph_targets[t].position_deltas; !deltas.empty())
      bind += morph_weights_[mesh.first_morph_weight + t] * deltas[vertex];
  const std::vector<Columns>& palette = palettes_[mesh.skin];
  Columns blended;
  blended.fill(Column::Zero());
  for (const Influence& influence : mesh.weights.of(vertex))
    for (std::size_t c = 0; c < 4; ++c) blended[c] += influence.weight * palette[influence.slot][c];
  const Column posed =
      blended[0] * bind.x() + blended[1] * bind.y() + blended[2] * bind.z() + blended[3];
  return posed.head<3>();
}

}  // namespace sunder::particles
