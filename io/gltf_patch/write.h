#pragma once

#include <sunder/io/character_bytes.h>

#include <cstddef>
#include <vector>

namespace sunder::gltf {

/// The GLB that save_glb() writes. Throws Refusal.
[[nodiscard]] std::vector<std::byte> glb_of(const Character& character,
                                            const LoadedCharacter& loaded,
                                            const SaveOptions& options);

/// See sunder::written_influences().
[[nodiscard]] Result<std::vector<WrittenInfluences>> influences_of_written(
    const Character& character, const LoadedCharacter& loaded, const SaveOptions& options);

}  // namespace sunder::gltf
