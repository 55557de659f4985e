#pragma once

#include <sunder/io/character_bytes.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace sunder {

/// Where the importer of a format other than glTF runs.
enum class ImportPlace : std::uint8_t {
  /// In a helper executable with limits on memory, time, files and system calls, so that a file
  /// that crashes its importer, or takes it over, harms nothing else.
  helper_process,
  /// In the caller's process, without limits. For trusted files only.
  in_process,
};

/// `strict` implies `requires_filter`.
struct LoadOptions : ReadOptions {
  /// Refuses to import where the helper process cannot filter its system calls (built without
  /// libseccomp, or a system without it). Otherwise the report warns of it.
  bool requires_filter = false;
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

/// Writes `character`, which is `loaded.character` changed by tearing or with other weights, as a
/// GLB: the source document with new accessors for the meshes that differ and for those that
/// loading repaired. Appended bones become nodes, and a mesh may take an appended skin; clips that
/// differ, or are appended, become animations. Morph targets may be appended, as many to all meshes
/// of a node. A submesh may name a material of the source or of SaveOptions::materials. All else
/// stays as it was, but for faults, which are repaired or removed, and for data that nothing uses
/// any more, which is left out (docs/io.md). If nothing differs and the source is a GLB without
/// faults, the result is the source, byte for byte. Thread-safe.
///
/// @param character  begins with the skeleton, skins and (perhaps edited) clips of `loaded`.
/// @return invalid_argument, size_mismatch (not the same character, a clip that glTF cannot
///         express, too few formats), file_unreadable (cannot write).
///         A failing call leaves no file behind and an existing file as it was.
[[nodiscard]] SUNDER_API Status save_glb(const std::filesystem::path& file,
                                         const Character& character, const LoadedCharacter& loaded,
                                         const SaveOptions& options = {});

/// Writes a character that was not loaded from a file: nodes, skins, meshes, clips, and a plain
/// material per submesh.
/// @return as above; the first fault if `character` is not valid.
[[nodiscard]] SUNDER_API Status save_glb(const std::filesystem::path& file,
                                         const Character& character,
                                         const SaveOptions& options = {});

}  // namespace sunder
