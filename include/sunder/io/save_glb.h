#pragma once

#include <sunder/io/load_character.h>

#include <filesystem>

namespace sunder {

/// How a file holds the weights of influences. Integers are glTF's normalised ones; those of a vertex sum to exactly 65535 or 255
/// over all its WEIGHTS_n, each less than one unit from its weight. See <sunder/weights/quantise.h>.
enum class WeightFormat : std::uint8_t { float32, unorm16, unorm8 };

/// What becomes of the influences of meshes that are written. Meshes that stay as the source document has them keep theirs.
struct SaveOptions {
  /// Most influences written a vertex, largest first, renormalised: 4 or 8; 0 writes all, in as many JOINTS_n / WEIGHTS_n as
  /// needed. See <sunder/weights/prune.h>.
  std::uint32_t maximum_influences = 0;
  WeightFormat weights = WeightFormat::float32;
};

/// Writes `character`, which is `loaded.character` changed by tearing, as a GLB: the source document with new accessors for the
/// meshes that differ; where any does, also for those that loading had to repair. Everything else in it (materials, textures,
/// extras, extensions, animations, untouched meshes) stays as it was. Skeleton, skins and clips must be those of
/// `loaded.character`.
///
/// Where nothing differs and the source was a GLB, the result is the source, byte for byte.
/// @return invalid_argument, size_mismatch (not the same character), file_unreadable (cannot write). A failing call leaves no file
///         behind and an existing file as it was.
[[nodiscard]] SUNDER_API Status save_glb(const std::filesystem::path& file, const Character& character,
                                         const LoadedCharacter& loaded, const SaveOptions& options = {});

/// Writes a character that did not come from a file: nodes, skins, meshes, clips, and a plain material a submesh.
/// @return invalid_argument, file_unreadable (cannot write), as above; the first fault where `character` is not valid.
[[nodiscard]] SUNDER_API Status save_glb(const std::filesystem::path& file, const Character& character,
                                         const SaveOptions& options = {});

}  // namespace sunder
