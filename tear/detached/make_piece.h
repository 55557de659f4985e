#pragma once

#include "tear/detached/piece_meshes.h"

namespace sunder::tear {

/// Makes the character of a piece, with its maps and its mass. Nothing for PieceMotion::none.
/// @param faces  ascending. @param pose  of the detachment.
/// @return the failures of skinning and of compute_mass(). @throws std::bad_alloc
[[nodiscard]] Result<DetachedPiece> make_piece(const std::vector<Index>& faces,
                                               const ModelPose& pose, const DetachOptions& options,
                                               const SurfaceEditor& editor);

}  // namespace sunder::tear
