#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "io/internal/staged_file.h"

namespace sunder::tools {

/// The bytes of a text, for a StagedFile.
[[nodiscard]] inline std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

/// Writes the whole text or nothing.
/// @return file_unreadable.
[[nodiscard]] inline Status write_text(const std::filesystem::path& file, std::string_view text) {
  return write_file(file, bytes_of(text));
}

}  // namespace sunder::tools
