#pragma once

#include <filesystem>

namespace sunder::bench {

/// Median processor seconds to read one GLB from the disk cache, measured in turns in one run.
struct ImportTimes {
  double ours = 0;      ///< load_character(), with all its checks.
  double assimp = 0;    ///< Importer::ReadFile() without post-processing.
  double tinygltf = 0;  ///< LoadBinaryFromFile() without decoding images; no accessor is decoded.
};

/// @param rounds  turns of each reader; each takes at least half a millisecond.
[[nodiscard]] ImportTimes time_imports(const std::filesystem::path& glb, int rounds);

}  // namespace sunder::bench
