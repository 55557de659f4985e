#pragma once

#include <span>
#include <vector>

#include "tools/picture/open_lips.h"

namespace sunder::tools {

/// Narrows wounds towards their tips like ellipses, where particles leave them blunt: moves points
/// of the two lips towards each other, and the surface beside them along, so that it does not fold.
/// Where a wound ends at a border or on another wound, it stays wide. Then unfold_skin().
/// @param closed, open  in one pose, of the instance.
void taper_wounds(const CharacterInstance& instance, std::span<const Wound> wounds,
                  const std::vector<DeformedMesh>& closed, std::vector<DeformedMesh>& open);

}  // namespace sunder::tools
