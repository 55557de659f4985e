#pragma once

#include <sunder/core/character.h>

#include <span>
#include <vector>

namespace sunder {

/// Computes model_from_bind = model_from_bone * bone_from_bind for each slot of a skin.
/// @param model_from_bind  one matrix per slot of `skin`, written.
/// @return ok; size_mismatch or index_out_of_range (nothing is written). O(slots), no allocation.
/// Reentrant.
[[nodiscard]] SUNDER_API Status compute_palette(const Skin& skin, const ModelPose& pose,
                                                std::span<Affine3d> model_from_bind);

/// The same, multiplied in double and stored in float.
[[nodiscard]] SUNDER_API Status compute_palette(const Skin& skin, const ModelPose& pose,
                                                std::span<Affine3f> model_from_bind);

/// The matrix that transforms normals for the linear part of a bone: the part itself if it scales
/// all directions alike within 1e-5 (rotations, uniform scales, mirrors); otherwise its inverse
/// transpose, scaled to the same Frobenius norm. Outward normals stay outward under mirrors. Flat
/// maps have one too; a rank below 2 gives zero. Normals are posed by sum_k w_k of these matrices.
[[nodiscard]] SUNDER_API Mat3d compute_normal_matrix(const Mat3d& linear);

/// The vertices of a mesh in model space. V is the number of vertices.
struct DeformedMesh {
  std::vector<Vec3f> positions;  ///< V.
  std::vector<Vec3f> normals;    ///< V, or empty if the mesh has none. Unit length.
  std::vector<Vec4f> tangents;   ///< V, or empty if the mesh has none. Unit xyz.
};

/// Deforms a mesh once: morph targets, then linear blend skinning,
///   p = sum_k w_k M_k (position + sum_j m_j delta_j). For repeated use see SkinnedMesh.
///
/// @param model_from_bind  one matrix per slot of the mesh's skin; may hold scale, shear, mirrors.
/// @param morph_weights    all weights of the pose (ModelPose::morph_weights).
/// @param out              resized to fit.
/// @return ok; size_mismatch, non_finite_value, the failures of SkinnedMesh::create(), and
/// limit_exceeded, out of memory (nothing is written). O(V x (influences + morph targets)),
/// allocates. Reentrant. Source: Magnenat-Thalmann et al. 1988 [magnenat1988joint]; normals:
/// docs/skinning.md.
[[nodiscard]] SUNDER_API Status deform_mesh(const Mesh& mesh,
                                            std::span<const Affine3f> model_from_bind,
                                            std::span<const float> morph_weights,
                                            DeformedMesh& out);

}  // namespace sunder
