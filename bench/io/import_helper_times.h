#pragma once

#include <filesystem>
#include <string>

namespace sunder::bench {

/// An FBX file, loaded by load_character() with the helper process and by assimp's own ReadFile()
/// in this process, in turns.
struct FbxTimes {
  std::string file;           ///< Name; empty if no FBX file was found.
  std::size_t vertices = 0;   ///< As assimp imports them: one per triangle corner.
  double ours = 0;            ///< Median seconds: helper started, scene converted, GLB read.
  double in_process = 0;      ///< The same without the helper process.
  double assimp = 0;          ///< The importer with the same options and post-processing.
  double child_overhead = 0;  ///< Median of the differences ours - in_process, per round.
};

/// The largest FBX file of the shared models, or of Debian's assimp-testmodels without them.
[[nodiscard]] std::filesystem::path fbx_file();

/// Writes a model of any format as FBX text, by assimp's exporter.
/// @return empty if assimp cannot.
[[nodiscard]] std::filesystem::path write_fbx(const std::filesystem::path& model,
                                              const std::filesystem::path& folder);

[[nodiscard]] FbxTimes time_fbx(const std::filesystem::path& file, int rounds);

/// Reads a file as time_fbx() lets assimp read it. @return the number of vertices; 0: it cannot.
[[nodiscard]] std::size_t read_by_assimp(const std::filesystem::path& file);

}  // namespace sunder::bench
