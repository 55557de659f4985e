#pragma once

#include "tear/path/surface_hit.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// How far places move onto points and edges that exist already.
enum class Snapping : std::uint8_t {
  by_shape,     ///< kSnapEdges, and kSliverSizes where tears were.
  near,         ///< kSnapEdges, at the end of a path: its tip is where the blade was.
  near_or_lip,  ///< The same, but kSliverSizes to lips.
  tight,        ///< The least distance at which two places are stored apart, and kTightSnapEdges.
};

/// Whether an edge is part of a lip or of another border: it has no other side, or a wall hangs
/// from it.
[[nodiscard]] bool is_lip(Index half_edge, const SurfaceEditor& editor);

/// The fraction of an edge, from either end, within which a place snaps to that end.
[[nodiscard]] double snapped_part(Index half_edge, Snapping snapping, const SurfaceEditor& editor,
                                  PosedPoints& posed);

/// The fraction of the height of a face over a corner's far edge within which a place snaps to that
/// edge.
[[nodiscard]] double snapped_height(Index corner, Snapping snapping, const SurfaceEditor& editor,
                                    PosedPoints& posed);

/// Whether a place snaps to a corner of its face that is on a lip.
[[nodiscard]] bool is_at_lip_corner(const SurfaceHit& hit, Index corner, Snapping snapping,
                                    const SurfaceEditor& editor, PosedPoints& posed);

/// The fraction of an edge, from either end, within which a place would be stored as that end, to a
/// few units in the last place.
[[nodiscard]] double stored_part(Index half_edge, const SurfaceEditor& editor);

/// The fraction of the height of a face over a corner's far edge within which a place would be
/// stored on that edge, to a few units in the last place.
[[nodiscard]] double stored_height(Index corner, const SurfaceEditor& editor);

}  // namespace sunder::tear
