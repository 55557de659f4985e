#include "skinning/internal/reference.h"

#include <sunder/skinning/deform.h>

#include "core/internal/ordered.h"
#include "skinning/blend.h"

namespace sunder {

Vec3d deform_position_reference(const Mesh& mesh, std::uint32_t vertex,
                                std::span<const Affine3d> model_from_bind,
                                std::span<const float> morph_weights) {
  return deform_position_reference(mesh, vertex, mesh.positions[vertex], mesh.weights.of(vertex),
                                   model_from_bind, morph_weights);
}

Vec3d deform_position_reference(const Mesh& mesh, std::uint32_t vertex, const Vec3f& position,
                                std::span<const Influence> influences,
                                std::span<const Affine3d> model_from_bind,
                                std::span<const float> morph_weights) {
  const Eigen::Vector3d bind = skinning::add_morphs(
      mesh, vertex, morph_weights, position.cast<double>(), &MorphTarget::position_deltas);
  const auto blended = skinning::blend_matrix(influences, model_from_bind);
  return transform(blended, bind);
}

Vec3d deform_normal_reference(const Mesh& mesh, std::uint32_t vertex,
                              std::span<const Affine3d> model_from_bind,
                              std::span<const float> morph_weights) {
  const Eigen::Vector3d bind =
      skinning::add_morphs(mesh, vertex, morph_weights, mesh.normals[vertex].cast<double>(),
                           &MorphTarget::normal_deltas);
  Mat3d blended = Mat3d::Zero();
  for (const Influence& influence : mesh.weights.of(vertex))
    blended += static_cast<double>(influence.weight) *
               compute_normal_matrix(model_from_bind[influence.slot].linear());
  return skinning::unit_or(multiply(blended, bind), bind);
}

}  // namespace sunder
