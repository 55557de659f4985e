#pragma once

#include <sunder/tear/report.h>

#include "tear/sheet/open_sheet.h"

namespace sunder::tear {

/// Closes the flat section that a cut opened, on both sides: each closed rim, or rim with the holes
/// in it, gets a cap with a submesh of its own ("cap"), texture coordinates over its extent, and
/// weights that are harmonic between those of the rim. The cap shares its rim's points: there is no
/// crack in any pose.
///
/// Rims of meshes with different skins are different bodies. What does not close is counted in
/// `open_sections` and left open.
/// @param normal  of the cut's plane, unit length; left is where it points.
void add_caps(const SheetOpening& opening, const Vec3d& normal, const Workpiece& work,
              TearReport& report);

}  // namespace sunder::tear
