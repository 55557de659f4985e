#pragma once

#include "io/assimp/mesh_part.h"

namespace sunder::assimp_import {

/// Merges vertices that agree bit for bit in every attribute, morph displacement and weight; the
/// first of each stays, in order. O(size) expected. @return how many vertices went.
std::uint32_t weld_identical(MeshPart& part);

}  // namespace sunder::assimp_import
