#pragma once

#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// Gives both sides of the source's cracks points in the same bind places: in another pose the
/// sides are apart, so a path crosses each of them elsewhere, and a surface that is closed in bind
/// space would get holes as wide as the rounding of positions. Nothing is to be done in a source
/// without cracks. O(points since the mark x parts of the triangles across the crack)
/// @param since  the begin of this step.
/// @return number of points for which the other side could not be split.
Index match_crack_points(const EditLog::Mark& since, const Workpiece& work);

}  // namespace sunder::tear
