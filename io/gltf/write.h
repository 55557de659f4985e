#pragma once

#include <sunder/io/character_file.h>

namespace sunder::gltf {

/// See save_glb().
[[nodiscard]] Status write_character(const std::filesystem::path& file, const Character& character,
                                     const LoadedCharacter& loaded, const SaveOptions& options);

/// See sunder::written_influences().
[[nodiscard]] Result<std::vector<WrittenInfluences>> influences_of_written(
    const Character& character, const LoadedCharacter& loaded, const SaveOptions& options);

}  // namespace sunder::gltf
