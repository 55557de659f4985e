#pragma once

#include <sunder/io/character_file.h>

#include <filesystem>

#include "io/assimp/imported_glb.h"

namespace sunder::contained_import {

using assimp_import::ImportedGlb;

/// Reads `file` by assimp, in a helper process with limits or, with options.import_place, in this
/// one, and returns it as a GLB. Both give the same bytes. Thread-safe.
///
/// @return file_not_found, file_unreadable (both also for the helper executable),
///         unsupported_format (also for glTF, which has its own reader), malformed_file (also if
///         the importer crashed), path_not_allowed, limit_exceeded, empty_input (no triangle),
///         non_finite_value, index_out_of_range; with options.strict the first fault that would
///         have been repaired.
[[nodiscard]] Result<ImportedGlb> import_as_glb(const std::filesystem::path& file,
                                                const LoadOptions& options);

}  // namespace sunder::contained_import
