#pragma once

#include <sunder/io/character_bytes.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "io/gltf/decoders.h"
#include "io/gltf/side_files.h"

namespace sunder::gltf {

/// Reads a glTF (JSON text) or GLB from memory. Without `side_files`, only data: URIs are allowed.
/// The content is kept as the source document.
[[nodiscard]] Result<LoadedCharacter> read_character(std::vector<std::byte> content,
                                                     std::shared_ptr<const SideFiles> side_files,
                                                     const ReadOptions& options,
                                                     const Decoders& decoders);

}  // namespace sunder::gltf
