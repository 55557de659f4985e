#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "io/import_checks/formats.h"

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

/// Whether read_text_indices() reads this format: OFF, OBJ, MD5 and X in text form.
[[nodiscard]] bool has_text_indices(const Format& format);

/// Reads the content of a file; other formats give nothing.
[[nodiscard]] TextIndices read_text_indices(const Format& format, const std::string& text);

}  // namespace sunder::assimp_import
