#include <sunder/skinning/deform.h>

#include "skinning/blend.h"

namespace sunder {
Status deform_mesh(const Mesh& mesh, std::span<const Affine3f> model_from_bind, std::span<const float> morph_weights,
                   DeformedMesh& out) {
  if (mesh.first_morph_weight + mesh.morph_targets.size() > morph_weights.size())
    return Status::failure(StatusCode::size_mismatch, kNone, "mesh '%.80s' reads morph weights up to %zu, the pose has %zu",
                           mesh.name.c_str(), mesh.first_morph_weight + mesh.morph_targets.size(), morph_weights.size());
  for (const Influence& influence : mesh.weights.influences)
    if (influence.slot >= model_from_bind.size())
      return Status::failure(StatusCode::size_mismatch, influence.slot, "mesh '%.80s' uses bone slot %u, the palette has %zu",
                             mesh.name.c_str(), influence.slot, model_from_bind.size());

  const std::uint32_t count = mesh.vertex_count();
  out.positions.resize(count);
  out.normals.resize(mesh.normals.size());
  out.tangents.resize(mesh.tangents.size());
  for (std::uint32_t v = 0; v < count; ++v) {
    const auto blended = skinning::blend_matrix<float>(mesh.weights.of(v), model_from_bind);
    const Eigen::Matrix3f linear = blended.leftCols<3>();
    const Eigen::Vector3f position =
        skinning::add_morphs<float>(mesh, v, morph_weights, mesh.positions[v], &MorphTarget::position_deltas);
    out.positions[v] = linear * position + blended.col(3);
    if (!mesh.normals.empty()) {
      const Eigen::Vector3f normal =
          skinning::add_morphs<float>(mesh, v, morph_weights, mesh.normals[v], &MorphTarget::normal_deltas);
      out.normals[v] = skinning::unit_or<float>(skinning::cofactor<float>(linear) * normal, normal);
    }
    if (!mesh.tangents.empty()) {
      const Eigen::Vector3f tangent =
          skinning::add_morphs<float>(mesh, v, morph_weights, mesh.tangents[v].head<3>(), &MorphTarget::tangent_deltas);
      const Eigen::Vector3f deformed = skinning::unit_or<float>(linear * tangent, tangent);
      out.tangents[v] = {deformed.x(), deformed.y(), deformed.z(), mesh.tangents[v].w()};
    }
  }
  return {};
}

}  // namespace sunder
