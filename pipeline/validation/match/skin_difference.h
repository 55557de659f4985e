#pragma once

#include <sunder/certificate/certificate.h>

#include "pipeline/validation/match/skin_terms.h"
#include "pipeline/validation/match/surface_match.h"

namespace sunder::validation {

/// Per vertex of the target (all meshes one after the other): the skinned vertex minus the skinned
/// place of the source that it was matched to, as terms of the source's skeleton. Posed, a term is
/// model_from_bind(bone) * (x, m) with model_from_bind = model_from_bone * inverse(model_from_bone
/// in bind_pose(source)), one matrix per bone for all meshes.
///
/// Positions of each skin are carried into model space by its own bind matrices: x = w *
/// (model_from_bone at the source's bind) * (bone_from_bind of the slot) * p. Bones of the target
/// without a counterpart move with BoneMatch::driver_of_target. Terms that are exactly zero are
/// left out, so a vertex with the same skin has none. A vertex whose match is not accepted has none
/// either: see SurfaceMatches. Weights are taken as they are, so m sums to zero only as far as the
/// sums of weights agree. Morph targets are not included.
/// @param matches  of the target's vertices on the source.
/// @param skins    of both.
/// O(vertices x influences), allocates.
[[nodiscard]] SkinDifferences difference_of(const Character& source, const Character& target,
                                            const SurfaceMatches& matches,
                                            const DrivenSkins& skins);

}  // namespace sunder::validation
