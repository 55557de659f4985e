#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <filesystem>
#include <span>

namespace sunder {

/// Writes all of it or nothing: to a new file beside, which then takes the place of `file`.
/// @return file_unreadable.
Status write_atomically(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace sunder
