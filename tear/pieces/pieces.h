#pragma once

#include <sunder/tear/report.h>

#include <vector>

#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// The parts into which what changed since `begin` fell, by the edges that were opened or faces
/// that were removed, but for the one that is left of each thing.
///
/// Fronts start from every changed face and grow in turn; those that meet are one. It ends when one
/// front is left that has not run out: so it costs what the small pieces cost.
/// @return nothing where everything still hangs together.
[[nodiscard]] std::vector<TornPiece> find_pieces(const SurfaceEditor::Mark& begin,
                                                 const SurfaceEditor& editor, PosedPoints& posed);

/// The same and what is left, too. O(all faces).
[[nodiscard]] std::vector<TornPiece> find_all_pieces(const SurfaceEditor::Mark& begin,
                                                     const SurfaceEditor& editor,
                                                     PosedPoints& posed);

}  // namespace sunder::tear
