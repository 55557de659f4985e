#pragma once

#include <sunder/io/character_file.h>

#include "io/assimp/asset_io_system.h"
#include "io/assimp/imported_glb.h"
#include "io/files/allowed_files.h"

namespace sunder::contained_import {

/// Imports `model` in a helper process and opens the files for which it asks. The process is reaped
/// before the call returns, also if the process crashes, hangs or misbehaves.
///
/// @return what the import returned; limit_exceeded (time, memory, size of the reply, no process);
///         malformed_file if the import crashed or replied something else; file_not_found or
///         file_unreadable for the helper executable.
[[nodiscard]] Result<assimp_import::ImportedGlb> run_helper(const assimp_import::ModelFile& model,
                                                            files::AllowedFiles& allowed,
                                                            const LoadOptions& options);

}  // namespace sunder::contained_import
