#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sunder::bench {

struct IoFile {
  std::string name;
  std::filesystem::path path;
  std::size_t vertices = 0;  ///< Of all meshes.
  std::size_t clips = 0;
};

/// Small animated characters as GLB: those of the shared models, or the demo's rig without them.
[[nodiscard]] std::vector<IoFile> small_characters(const std::filesystem::path& folder);

/// One animated character, subdivided to about 10 thousand to `largest` vertices and written as GLB
/// to `folder`: mannequiny.glb of the shared models, or the demo's rig without them. Sorted by
/// size; each has at least four vertices for one of the file before.
[[nodiscard]] std::vector<IoFile> growing_files(const std::filesystem::path& folder,
                                                std::size_t largest);

/// The same character with about `vertices` vertices.
[[nodiscard]] IoFile large_file(const std::filesystem::path& folder, std::size_t vertices);

}  // namespace sunder::bench
