#pragma once

#include <sunder/core/mesh.h>

#include <span>
#include <string>

#include <assimp/mesh.h>

#include "io/assimp/notes.h"

namespace sunder::assimp_import {

/// All influences of a mesh's vertices, largest first: finite, positive, no slot twice, with a
/// float sum of 1 within 2e-7 times their number. Weights that satisfy this are kept bit for bit;
/// vertices without influences follow slot 0.
/// @param slot_of_bone  one per bone of the mesh; kNone: its weights are ignored.
[[nodiscard]] SkinWeights read_weights(const aiMesh& mesh,
                                       std::span<const std::uint32_t> slot_of_bone,
                                       const std::string& place, Notes& notes);

}  // namespace sunder::assimp_import
