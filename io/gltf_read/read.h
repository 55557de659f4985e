#pragma once

#include <sunder/io/character_file.h>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace sunder::gltf {

/// Reads a glTF (JSON text) or GLB from memory. Relative URIs may refer to files in `folder` and
/// below; if it is empty, only data: URIs are allowed. The content is kept as the source document.
[[nodiscard]] Result<LoadedCharacter> read_character(std::vector<std::byte> content,
                                                     const std::filesystem::path& folder,
                                                     const LoadOptions& options);

}  // namespace sunder::gltf
