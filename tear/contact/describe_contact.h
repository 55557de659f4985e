#pragma once

#include "tear/contact/searches.h"

namespace sunder::tear {

/// Everything about a place of the surface that does not depend on the query.
[[nodiscard]] SurfaceContact describe_place(Index face, const std::array<double, 3>& barycentric,
                                            bool interpolates_normals, PosedSurface& surface);

/// The outward direction at a place that may lie on an edge or a point, by which the two sides of
/// a closed surface can be told apart: the normals of its faces, weighted by their angles there.
/// Not of unit length. Baerentzen and Aanaes 2005.
[[nodiscard]] Vec3d outward_at(const FoundPlace& place, PosedSurface& surface);

}  // namespace sunder::tear
