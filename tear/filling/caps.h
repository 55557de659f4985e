#pragma once

#include <sunder/tear/report.h>

#include "tear/sheet/open_sheet.h"

namespace sunder::tear {

/// Closes the flat section opened by a cut, on both sides. Each closed rim with its holes gets a
/// cap, which has a submesh of its own ("cap"), texture coordinates over its extent, and weights
/// that are harmonic between those of the rim. The cap shares the points of its rim, so there is no
/// crack in any pose.
///
/// Rims of meshes with different skins belong to different bodies. Rims that cannot be closed are
/// counted in `open_sections` and stay open.
/// @param normal  of the plane of the cut, unit length; it points to the left.
/// @param material  of the caps; kNone: that of the rim.
/// @param lips  appended: points that the opening left together for a cap that was not made.
void add_caps(const SheetOpening& opening, const Vec3d& normal, Index material,
              const Workpiece& work, TearReport& report, std::vector<LipPair>& lips);

}  // namespace sunder::tear
