#pragma once

#include <sunder/tear/change_record.h>

#include <vector>

#include "tear/surface_editor.h"

namespace sunder::tear {

/// Opens the surface along a run of edges: both sides of each edge are disconnected, and each point whose faces fall apart into
/// several fans becomes several points. Faces right of the path keep their points; a point whose faces stay together is a tip.
///
/// @param side  _TEARSIDE of the first new point of each place; higher ones where a place falls into more than two. Set to the next
/// free value.
/// @param lips  appended: left and right points in order along the path.
void open_path(const std::vector<Index>& path, SurfaceEditor& editor, Index& side, std::vector<LipPair>& lips);

}  // namespace sunder::tear
