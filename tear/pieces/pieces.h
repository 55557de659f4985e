#pragma once

#include <sunder/tear/report.h>

#include <vector>

#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// Finds the connected components that the changes since `begin` separated, except one remaining
/// part of each former component.
///
/// Fronts start from every changed face and grow in turn; fronts that meet are merged. The search
/// ends when at most one front per former component can still grow, so it costs only what the small
/// pieces cost.
/// @return nothing if everything is still connected.
[[nodiscard]] std::vector<TornPiece> find_pieces(const EditLog::Mark& begin,
                                                 const SurfaceEditor& editor, PosedPoints& posed);

/// The same including the remaining part. O(all faces).
[[nodiscard]] std::vector<TornPiece> find_all_pieces(const EditLog::Mark& begin,
                                                     const SurfaceEditor& editor,
                                                     PosedPoints& posed);

}  // namespace sunder::tear
