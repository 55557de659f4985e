#pragma once

#include "io/assimp/mesh_part.h"

namespace sunder::assimp_import {

/// Merges vertices that are equal, bit for bit, in every attribute, morph displacement and weight.
/// The first of them stays; the order is kept. O(size) expected.
/// @return number of removed vertices.
std::uint32_t weld_identical(MeshPart& part);

}  // namespace sunder::assimp_import
