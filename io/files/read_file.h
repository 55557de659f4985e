#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/files/allowed_files.h"

namespace sunder::files {

/// The content of an open regular file, from where it stands to its end, also if that has moved
/// since it was opened.
/// @return file_unreadable; limit_exceeded above `maximum_bytes`.
[[nodiscard]] Result<std::vector<std::byte>> read_all(const OpenFile& file,
                                                      std::uint64_t maximum_bytes);

/// The first bytes of a regular file, `most` at most; none if it cannot be read.
[[nodiscard]] std::string read_head(const std::filesystem::path& file, std::size_t most);

}  // namespace sunder::files
