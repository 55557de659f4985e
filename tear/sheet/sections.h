#pragma once

#include <span>
#include <vector>

#include "tear/geometry/plane_side.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// Restricts a sheet to sections. A section is a connected run of faces that the sheet meets: two
/// faces are connected if its plane crosses their common edge within the bounds.
///
/// @param places  the section nearest to each place stays; of sections at the same distance, within
///         rounding, all stay. Without places all stay.
/// @param faces   of faces_across(), ascending.
/// @return the faces that stay, ascending. O(faces x (log faces + places + bounds)).
[[nodiscard]] std::vector<Index> faces_of_sections(const Sheet& sheet,
                                                   std::span<const Vec3d> places,
                                                   std::vector<Index> faces,
                                                   const SurfaceEditor& editor, PosedPoints& posed);

}  // namespace sunder::tear
