#pragma once

#include <sunder/io/character_file.h>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace sunder::assimp_import {

struct ImportedGlb {
  std::vector<std::byte> glb;  ///< Valid glTF 2.0 binary: the whole scene with meshes, skins,
                               ///< clips, morph targets, materials.
  LoadReport report;
};

/// Reads `file` by assimp in a child process with limits on time and memory, and returns it as a
/// GLB.
///
/// The child is a fork without exec, so only the calling thread continues in it, and a lock that
/// another thread held stays locked. glibc's own locks are safe, also in malloc; those of another
/// allocator may not be. If assimp waits for such a lock, the child is killed after
/// options.import_seconds, and the call returns limit_exceeded. The host is never blocked. To avoid
/// this, import before other threads start.
///
/// @return file_not_found, file_unreadable, unsupported_format (also for glTF, which has its own
///         reader), malformed_file (also if the importer crashed), path_not_allowed,
///         limit_exceeded, empty_input (no triangle), non_finite_value, index_out_of_range; with
///         options.strict the first fault that would have been repaired.
[[nodiscard]] Result<ImportedGlb> import_as_glb(const std::filesystem::path& file,
                                                const LoadOptions& options);

}  // namespace sunder::assimp_import
