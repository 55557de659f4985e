#pragma once

#include <sunder/io/character_file.h>

#include <cstddef>
#include <filesystem>
#include <span>

namespace sunder::gltf {

/// Reads a glTF (JSON text) or GLB from memory. `folder`: where its relative URIs may point, itself
/// and below; empty refuses every URI but data: ones.
[[nodiscard]] Result<LoadedCharacter> read_character(std::span<const std::byte> content,
                                                     const std::filesystem::path& folder,
                                                     const LoadOptions& options);

}  // namespace sunder::gltf
