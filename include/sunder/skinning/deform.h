#pragma once

#include <sunder/core/character.h>

#include <span>
#include <vector>

namespace sunder {

/// model_from_bind of each slot of a skin: model_from_bone * bone_from_bind.
/// @param model_from_bind  one a slot of `skin`, written.
/// @return ok; size_mismatch or index_out_of_range (nothing written). O(slots), no allocation.
[[nodiscard]] SUNDER_API Status compute_palette(const Skin& skin, const ModelPose& pose,
                                                std::span<Affine3d> model_from_bind);

/// The same, multiplied in double, stored in float.
[[nodiscard]] SUNDER_API Status compute_palette(const Skin& skin, const ModelPose& pose,
                                                std::span<Affine3f> model_from_bind);

/// How a bone's linear part turns normals: itself where it scales all directions alike (within
/// 1e-5: rotations, uniform scales, mirrors of both); else its inverse transpose at the linear
/// part's own scale (by the Frobenius norm), outward under mirrors. A flat map has one too; what
/// leaves no plane has zero. Normals are posed by sum_k w_k of these.
[[nodiscard]] SUNDER_API Mat3d compute_normal_matrix(const Mat3d& linear);

/// A mesh's vertices in model space.
struct DeformedMesh {
  std::vector<Vec3f> positions;  ///< V.
  std::vector<Vec3f> normals;    ///< V or none, as the mesh. Unit length.
  std::vector<Vec4f> tangents;   ///< V or none, as the mesh. Unit xyz.
};

/// Deforms a mesh once: its morph targets, then linear blend skinning. For frame after frame see
/// SkinnedMesh, which this makes and forgets.
///   p = sum_k w_k M_k (position + sum_j m_j delta_j), normals by sum_k w_k
///   compute_normal_matrix(M_k), made unit length.
///
/// @param model_from_bind  one a slot of the mesh's skin, see compute_palette(). May hold scale,
/// shear, mirrors.
/// @param morph_weights    all weights of the pose (ModelPose::morph_weights).
/// @param out              resized to fit.
/// @return ok; size_mismatch, non_finite_value, and what SkinnedMesh::create() finds (nothing
/// written).
///
/// O(V x (influences + morph targets)), reentrant. A normal that is left without length keeps its
/// bind direction. Source: Magnenat-Thalmann et al. 1988 [magnenat1988joint]; normals: see
/// docs/skinning.md.
[[nodiscard]] SUNDER_API Status deform_mesh(const Mesh& mesh,
                                            std::span<const Affine3f> model_from_bind,
                                            std::span<const float> morph_weights,
                                            DeformedMesh& out);

}  // namespace sunder
