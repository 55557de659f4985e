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

/// Reads `file` by assimp in a child process with limits on time and memory, and hands it over as a
/// GLB.
///
/// The child is a fork without exec: of a host with many threads only the calling one lives on in
/// it, and a lock that another thread held at that moment stays locked there for ever. Only glibc's
/// own locks, those of its malloc included, are safe; another allocator's may not be. Should assimp
/// wait for such a lock, the child is killed after options.import_seconds and the call fails with
/// limit_exceeded; the host itself is never blocked or harmed. A host that wants none of this
/// imports at start-up, before it makes threads.
///
/// @return file_not_found, file_unreadable, unsupported_format (also glTF, which has its own
/// reader), malformed_file (also where
///         the importer crashed), path_not_allowed, limit_exceeded, empty_input (no triangle),
///         non_finite_value, index_out_of_range; with options.strict the first fault that would
///         have been repaired.
[[nodiscard]] Result<ImportedGlb> import_as_glb(const std::filesystem::path& file,
                                                const LoadOptions& options);

}  // namespace sunder::assimp_import
