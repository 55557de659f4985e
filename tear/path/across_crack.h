#pragma once

#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// The border half-edges, as the faces are now, that lie across a crack of the source from at least
/// a part of a half-edge. Empty if there is no crack, or if its sides are farther apart than
/// `farthest` in the pose.
[[nodiscard]] ScratchVector<Index> half_edges_across_crack(Index half_edge, double farthest,
                                                           const SurfaceEditor& editor,
                                                           const PosedPoints& posed);

}  // namespace sunder::tear
