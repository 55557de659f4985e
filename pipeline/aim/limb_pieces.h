#pragma once

#include <sunder/aim/aim.h>

#include "pipeline/aim/posed_surface.h"

namespace sunder::aim {

/// Finds the pieces that a limb is made of.
/// @return as limb_pieces(). O(faces x influences + bones squared).
[[nodiscard]] Result<LimbPieces> find_limb_pieces(const PosedSurface& surface,
                                                  const LimbPlace& place);

}  // namespace sunder::aim
