#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <filesystem>
#include <span>

namespace sunder {

/// Writes all bytes or none: to a new file in the same folder, which then replaces `file`.
/// @return file_unreadable.
Status write_atomically(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace sunder
