#pragma once

#include <sunder/io/character_bytes.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace sunder {

namespace gltf {
struct Decoders;
}

/// load_glb() with these decoders.
[[nodiscard]] Result<LoadedCharacter> load_bytes(std::vector<std::byte> bytes,
                                                 const ReadOptions& options,
                                                 std::shared_ptr<const FileResolver> resolver,
                                                 const gltf::Decoders& decoders);

/// load_glb() without third parties: compressed files are refused.
[[nodiscard]] Result<LoadedCharacter> load_plain_bytes(
    std::vector<std::byte> bytes, const ReadOptions& options,
    std::shared_ptr<const FileResolver> resolver);

}  // namespace sunder
