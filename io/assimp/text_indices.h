#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <vector>

namespace sunder::assimp_import {

/// References of a text file to entries that do not exist, which assimp replaces or leaves out
/// without a word.
struct TextIndices {
  /// Per mesh that assimp makes, the faces that name a vertex that does not exist.
  std::vector<std::set<std::uint32_t>> faces;
  /// Corners of faces that name a normal, or texture coordinates, that do not exist.
  std::uint32_t normals = 0, coordinates = 0;
  /// assimp reads beyond its arrays where they are used, so the file must be refused.
  bool is_dangerous = false;
};

/// Reads an OFF, OBJ, MD5 or X file in text form; other formats give nothing.
[[nodiscard]] TextIndices read_text_indices(const std::filesystem::path& file);

}  // namespace sunder::assimp_import
