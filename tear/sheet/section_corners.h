#pragma once

#include <span>

#include "tear/posed/posed_points.h"
#include "tear/surface/open.h"

namespace sunder::tear {

/// The corners of a flat section at the points in which it touches itself: where several of its
/// edges arrive at a point and as many leave it. Between an edge that leaves and the next one
/// counterclockwise, which must arrive, lies the section. A point where they do not alternate has
/// none. O(edges x log edges).
/// @param edges   directed, each once; the section is on their left as seen against `normal`.
/// @param normal  of the plane.
/// @return ascending by point.
[[nodiscard]] ScratchVector<SectionCorner> find_section_corners(std::span<const PointEdge> edges,
                                                                const Vec3d& normal,
                                                                const SurfaceEditor& editor,
                                                                PosedPoints& posed);

}  // namespace sunder::tear
