#pragma once

#include <sunder/io/character_file.h>

#include <filesystem>

#include "io/assimp/import_as_glb.h"

namespace sunder::assimp_import {

/// The work of the child process: reads the file by assimp and converts the whole scene. Throws
/// ImportFailure, and any exception of assimp.
[[nodiscard]] ImportedGlb read_and_convert(const std::filesystem::path& file,
                                           const LoadOptions& options);

}  // namespace sunder::assimp_import
