#pragma once

#include <sunder/tear/report.h>

#include <vector>

#include "tear/posed_points.h"

namespace sunder::tear {

/// The parts into which what changed since `begin` fell, by the edges that were opened or faces that were removed.
///
/// Fronts start from every changed face and grow in turn; those that meet are one. It ends when one front is left that has not run
/// out: so it costs what the small pieces cost.
/// @param all  also the piece that is left: O(its size). Else it is not named.
/// @return nothing where everything still hangs together.
[[nodiscard]] std::vector<Piece> find_pieces(const SurfaceEditor::Mark& begin, bool all, const SurfaceEditor& editor,
                                             PosedPoints& posed);

}  // namespace sunder::tear
