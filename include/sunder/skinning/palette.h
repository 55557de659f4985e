#pragma once

#include <sunder/core/character.h>

#include <span>
#include <vector>

namespace sunder {

/// model_from_bone of every bone: local transforms multiplied down the tree, in double.
/// @param model_pose  resized to fit; does not allocate when it already fits.
/// @return ok, or size_mismatch (nothing written).
[[nodiscard]] SUNDER_API Status compute_model_pose(const Skeleton& skeleton, const Pose& pose, ModelPose& model_pose);

/// The pose in which the skins were attached: model_from_bone = inverse(bone_from_bind), so that each skin reproduces its mesh.
/// Where several skins bind one bone differently the first one counts; a bone that no skin binds, or binds by a singular matrix,
/// keeps its rest transform relative to its parent. Morph weights are those of rest.
[[nodiscard]] SUNDER_API ModelPose bind_pose(const Character& character);

/// model_from_bind of each slot of a skin: model_from_bone * bone_from_bind.
/// @param model_from_bind  one a slot of `skin`, written.
/// @return ok; size_mismatch or index_out_of_range (nothing written). O(slots), no allocation.
[[nodiscard]] SUNDER_API Status compute_palette(const Skin& skin, const ModelPose& pose, std::span<Affine3d> model_from_bind);

/// The same, multiplied in double, stored in float.
[[nodiscard]] SUNDER_API Status compute_palette(const Skin& skin, const ModelPose& pose, std::span<Affine3f> model_from_bind);

/// How a bone's linear part turns normals: itself where it scales all directions alike (within 1e-5: rotations, uniform scales,
/// mirrors of both); else its inverse transpose at the linear part's own scale (by the Frobenius norm), outward under mirrors. A
/// flat map has one too; what leaves no plane has zero. Normals are posed by sum_k w_k of these.
[[nodiscard]] SUNDER_API Mat3d compute_normal_matrix(const Mat3d& linear);

}  // namespace sunder
