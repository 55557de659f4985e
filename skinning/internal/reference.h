#pragma once

#include <sunder/core/character.h>
#include <sunder/skinning/deform.h>

#include <span>

namespace sunder {

/// Poses one vertex by the definition of linear blend skinning, in double throughout: the oracle
/// for faster code, and the evaluation that tearing uses. Reentrant.
///
/// @param vertex           < mesh.vertex_count(), unchecked.
/// @param model_from_bind  one matrix per slot of the mesh's skin.
/// @param morph_weights    all weights of the pose.
/// O(influences + morph targets), no allocation.
[[nodiscard]] SUNDER_API Vec3d deform_position_reference(const Mesh& mesh, std::uint32_t vertex,
                                                         std::span<const Affine3d> model_from_bind,
                                                         std::span<const float> morph_weights);

/// Poses a vertex as if it had the given bind position and influences.
[[nodiscard]] SUNDER_API Vec3d deform_position_reference(const Mesh& mesh, std::uint32_t vertex,
                                                         const Vec3f& position,
                                                         std::span<const Influence> influences,
                                                         std::span<const Affine3d> model_from_bind,
                                                         std::span<const float> morph_weights);

/// The same for the normal: sum_k w_k compute_normal_matrix(M_k), unit length. The mesh must have
/// normals.
[[nodiscard]] SUNDER_API Vec3d deform_normal_reference(const Mesh& mesh, std::uint32_t vertex,
                                                       std::span<const Affine3d> model_from_bind,
                                                       std::span<const float> morph_weights);

}  // namespace sunder
