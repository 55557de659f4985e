#pragma once

#include <sunder/core/character.h>
#include <sunder/weights/influences.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace sunder {

/// The file from which a character was loaded, kept so that saving can patch it. Opaque.
class SourceDocument;

/// One kind of thing that loading repaired, dropped or reports, counted over the file.
struct LoadNote {
  enum class Kind : std::uint8_t {
    information,
    repaired,
    dropped,
    warning,  ///< The model is as in the file, but it was read with less protection than usual.
  };
  Kind kind = Kind::information;
  std::string place;        ///< "mesh 2 'Body'", "clip 'Walk'".
  std::string text;         ///< "weights did not sum to one and were normalised".
  std::uint32_t count = 1;  ///< Number of vertices, keys … concerned.
};

struct LoadReport {
  std::string format;  ///< "glTF 2.0 binary", "FBX by assimp".
  std::string space;   ///< Space and unit of the model: "metres, y up, as in the file".
  std::vector<LoadNote> notes;
};

/// Where the importer of a format other than glTF runs.
enum class ImportPlace : std::uint8_t {
  /// In a helper executable with limits on memory, time, files and system calls, so that a file
  /// that crashes its importer, or takes it over, harms nothing else.
  helper_process,
  /// In the caller's process, without limits. For trusted files only.
  in_process,
};

struct LoadOptions {
  /// Refuses what would otherwise be repaired or dropped; implies `requires_filter`.
  bool strict = false;
  /// Refuses to import where the helper process cannot filter its system calls (built without
  /// libseccomp, or a system without it). Otherwise the report warns of it.
  bool requires_filter = false;
  /// Limit for the file together with all files that it refers to.
  std::uint64_t maximum_bytes = std::uint64_t{2} << 30;
  /// Limit for the memory that reading takes, because a small file can describe a large model. 0:
  /// 20 times the size of the file and all files that it refers to, but at least 64 MiB.
  std::uint64_t maximum_memory = 0;
  ImportPlace import_place = ImportPlace::helper_process;
  /// Path of the helper executable `sunder-import`; if empty, it is searched for beside the library
  /// and the program.
  std::filesystem::path import_helper = {};
  /// Time limit of the helper process. > 0.
  double import_seconds = 10.0;
  /// Limit for the memory of the helper process in addition to what it needs to start. It gets less
  /// for small files: 64 bytes per byte of the files that it reads, but at least 256 MiB.
  std::uint64_t import_memory = std::uint64_t{4} << 30;
  /// Folders from which the model may read other files, in addition to its own.
  std::vector<std::filesystem::path> roots = {};
  /// Fills LoadedCharacter::stored, for validation. glTF and GLB only.
  bool keep_stored_influences = false;
};

struct LoadedCharacter {
  std::shared_ptr<const Character> character;    ///< Satisfies validate_character().
  std::shared_ptr<const SourceDocument> source;  ///< For save_glb().
  LoadReport report;
  /// One per mesh, with LoadOptions::keep_stored_influences; empty for formats other than glTF.
  std::vector<StoredInfluences> stored;
};

/// Reads all meshes of a model's scene, skinned or rigid, on one skeleton: glTF and GLB directly,
/// other formats (FBX, COLLADA, X, B3D, OBJ, PLY, OFF …) by assimp in a helper process with limits.
/// Model space is the scene's space, in metres. Thread-safe; details in docs/io.md.
///
/// @param file  its extension chooses the reader. Other files are read only from its own folder and
///              LoadOptions::roots.
/// @return file_not_found, file_unreadable, unsupported_format, unsupported_feature,
///         malformed_file, path_not_allowed, limit_exceeded; empty_input if there is no triangle;
///         with options.strict also the first fault that would have been repaired.
[[nodiscard]] SUNDER_API Result<LoadedCharacter> load_character(const std::filesystem::path& file,
                                                                const LoadOptions& options = {});

/// SaveOptions::maximum_influences that writes all.
inline constexpr std::uint32_t kAllInfluences = kNone;

/// A material without textures.
struct AppendedMaterial {
  std::string name;
  Vec4f base_colour = Vec4f::Ones();  ///< Linear RGBA, each 0 to 1.
  float metallic = 0.0f;              ///< 0 to 1.
  float roughness = 1.0f;             ///< 0 to 1.
  bool double_sided = false;

  bool operator==(const AppendedMaterial&) const = default;
};

/// How the influences of the meshes that are written are stored. Meshes that stay as they are in
/// the source document keep theirs.
struct SaveOptions {
  /// Largest number of influences per vertex, 4 or 8; the largest are kept and renormalised.
  /// kAllInfluences writes all, in as many JOINTS_n and WEIGHTS_n as needed. 0 writes no
  /// more than the vertex of the source that has the most, over all meshes, and at least four.
  std::uint32_t maximum_influences = 0;
  WeightFormat weights = WeightFormat::float32;
  /// One per mesh of the character, in place of `weights`; empty: `weights` for all.
  std::vector<WeightFormat> weights_of_mesh = {};
  /// Materials that Submesh::material counts after those of the source document. Only to save what
  /// was loaded.
  std::vector<AppendedMaterial> materials = {};
};

/// Writes `character`, which is `loaded.character` changed by tearing or with other weights, as a
/// GLB: the source document with new accessors for the meshes that differ and for those that
/// loading repaired. Appended bones become nodes, and a mesh may take an appended skin; clips that
/// differ, or are appended, become animations. Morph targets may be appended, as many to all meshes
/// of a node. A submesh may name a material of the source or of SaveOptions::materials. All else stays as it was, but for faults, which are repaired or removed (docs/io.md).
/// If nothing differs and the source is a GLB without faults, the result is the source, byte for
/// byte. Thread-safe.
///
/// @param character  begins with the skeleton, skins and (perhaps edited) clips of `loaded`.
/// @return invalid_argument, size_mismatch (not the same character, a clip that glTF cannot
///         express, too few formats), file_unreadable (cannot write).
///         A failing call leaves no file behind and an existing file as it was.
[[nodiscard]] SUNDER_API Status save_glb(const std::filesystem::path& file,
                                         const Character& character, const LoadedCharacter& loaded,
                                         const SaveOptions& options = {});

/// The influences of a mesh that save_glb() writes.
struct WrittenInfluences {
  std::uint32_t mesh = 0;             ///< In Character::meshes.
  std::uint32_t maximum = 0;          ///< Per vertex, by SaveOptions; 0: all.
  std::uint32_t most = 0;             ///< Of the vertex with the most, as written.
  std::uint64_t vertices_pruned = 0;  ///< Vertices that have more than the maximum.
  /// Largest share of a vertex's weight that is left out, in [0, 1).
  double dropped_mass_max = 0.0;
};

/// Predicts how save_glb() with the same arguments changes influences: one entry per mesh that it
/// would write and that has any, ascending. Nothing is written. How far a vertex moves by it in a
/// pose: pruning_displacement().
/// @return as save_glb(). O(influences), allocates.
[[nodiscard]] SUNDER_API Result<std::vector<WrittenInfluences>> written_influences(
    const Character& character, const LoadedCharacter& loaded, const SaveOptions& options = {});

/// Writes a character that was not loaded from a file: nodes, skins, meshes, clips, and a plain
/// material per submesh.
/// @return as above; the first fault if `character` is not valid.
[[nodiscard]] SUNDER_API Status save_glb(const std::filesystem::path& file,
                                         const Character& character,
                                         const SaveOptions& options = {});

}  // namespace sunder
