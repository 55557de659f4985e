#pragma once

#include <sunder/io/character_file.h>

#include "io/assimp/asset_io_system.h"
#include "io/assimp/imported_glb.h"

namespace sunder::assimp_import {

/// read_and_convert() without exceptions other than std::bad_alloc. Runs in the helper process, or
/// in the caller's if it asks for that.
[[nodiscard]] Result<ImportedGlb> import_scene(const ModelFile& model, AssetFiles& assets,
                                               const LoadOptions& options);

}  // namespace sunder::assimp_import
