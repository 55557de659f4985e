#pragma once

#include <sunder/io/character_file.h>

#include <optional>
#include <vector>

namespace sunder::tools {

/// Certifies how far, in any pose, appended vertices leave the places between their parents where
/// they were made: with the weights that the file gets, joints that turn by up to 180 degrees, and
/// without morph targets.
/// @param torn     the unpruned one.
/// @param origins  of its vertices.
/// @param stored   per mesh the weights of appended vertices as they are stored.
/// @return metres; nothing if there is no such bound: a vertex has none (see CertificateGap), the
/// bind pose of some bone is flat, or numbers are too large. limit_exceeded: out of memory.
[[nodiscard]] Result<std::optional<double>> bound_places(const Character& torn,
                                                         const std::vector<MeshOrigins>& origins,
                                                         const std::vector<SkinWeights>& stored);

/// The weights of appended vertices as save_glb() stores them.
/// @param torn  whose weights are written.
[[nodiscard]] Result<std::vector<SkinWeights>> stored_weights(
    const Character& torn, const LoadedCharacter& loaded, const std::vector<MeshOrigins>& origins,
    const SaveOptions& options);

}  // namespace sunder::tools
