#pragma once

#include <sunder/tear/report.h>

#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// Lists and measures the connected component of a live face. O(its faces), and a bit per face of
/// the surface.
[[nodiscard]] PieceDescription describe_piece(Index face, const SurfaceEditor& editor,
                                              PosedPoints& posed);

}  // namespace sunder::tear
