#pragma once

#include <sunder/io/character_bytes.h>

#include <cstdint>
#include <vector>

namespace sunder {

/// The glTF node of each mesh of a loaded character. Meshes of one node share its morph weights.
[[nodiscard]] SUNDER_API std::vector<std::uint32_t> nodes_of_meshes(const SourceDocument& source);

}  // namespace sunder
