#pragma once

#include <sunder/io/character_file.h>

#include "io/assimp/asset_io_system.h"
#include "io/assimp/imported_glb.h"

namespace sunder::assimp_import {

/// Reads the model by assimp and converts the whole scene. Throws ImportFailure, and any exception
/// of assimp.
[[nodiscard]] ImportedGlb read_and_convert(const ModelFile& model, AssetFiles& assets,
                                           const LoadOptions& options);

}  // namespace sunder::assimp_import
