#pragma once

#include <sunder/core/character.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace sunder {

/// The file behind a loaded character, kept so that saving can patch it. Opaque.
class SourceDocument;

/// One thing that loading repaired, dropped or wants known, counted over the file.
struct LoadNote {
  enum class Kind : std::uint8_t { information, repaired, dropped };
  Kind kind = Kind::information;
  std::string place;        ///< "mesh 2 'Body'", "clip 'Walk'".
  std::string text;         ///< "weights did not sum to one and were normalised".
  std::uint32_t count = 1;  ///< How many vertices, keys … it befell.
};

struct LoadReport {
  std::string format;  ///< "glTF 2.0 binary", "FBX by assimp".
  std::string space;   ///< Space and unit of the model: "metres, y up, as in the file".
  std::vector<LoadNote> notes;
};

struct LoadOptions {
  bool strict = false;                                   ///< Refuse what would otherwise be repaired or dropped.
  std::uint64_t maximum_bytes = std::uint64_t{2} << 30;  ///< Of the file and of everything that it refers to.
  double import_seconds = 120.0;                         ///< Limit for formats that are read in a child process. > 0.
};

struct LoadedCharacter {
  std::shared_ptr<const Character> character;    ///< Satisfies validate_character().
  std::shared_ptr<const SourceDocument> source;  ///< For save_glb().
  LoadReport report;
};

/// Reads a model: glTF and GLB directly, every other format (FBX, COLLADA, X, B3D, OBJ, PLY, OFF …) by assimp in a child process
/// with limits. All meshes of the file's scene, skinned or rigid, on one skeleton; model space is the scene's space, metres.
///
/// @param file  its extension chooses the reader; the content must agree. Other files are read only from its own folder.
/// @return file_not_found, file_unreadable, unsupported_format, unsupported_feature, malformed_file, path_not_allowed,
///         limit_exceeded; empty_input where there is no triangle; with options.strict also the first fault that would
///         have been repaired.
[[nodiscard]] SUNDER_API Result<LoadedCharacter> load_character(const std::filesystem::path& file, const LoadOptions& options = {});

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
