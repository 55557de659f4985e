#pragma once

#include <sunder/tear/change_record.h>
#include <sunder/tear/report.h>

#include <span>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Names the connected components that the changes from `begin` to `end` separated, except the body
/// of each former component. Later changes must not have separated any.
///
/// Fronts start from every changed face and grow in turn; fronts that meet are merged. The search
/// ends when at most one part is not known completely, and it crosses unchanged regions as a whole
/// (PieceSearch), so it costs what the changes cost. The first search of a model builds its cells.
/// @return nothing if everything is still connected.
[[nodiscard]] TornPieces find_pieces(const EditLog::Mark& begin, const EditLog::Extent& end,
                                     const SurfaceEditor& editor);

/// Names the components on both sides of lips, bodies included, where the lips separated any.
/// Fronts start along the lips.
[[nodiscard]] TornPieces find_pieces_at(std::span<const LipPair> lips, const SurfaceEditor& editor);

}  // namespace sunder::tear
