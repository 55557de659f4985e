#pragma once

#include <sunder/io/character_file.h>

#include <filesystem>

namespace sunder {

/// As save_glb() of a character that was not loaded from a file, but the materials that its
/// submeshes name are those of a loaded document, with their textures and images.
/// @return as save_glb(); index_out_of_range for a material that the document does not have.
[[nodiscard]] SUNDER_API Status save_with_materials(const std::filesystem::path& file,
                                                    const Character& character,
                                                    const SourceDocument& materials,
                                                    const SaveOptions& options = {});

}  // namespace sunder
