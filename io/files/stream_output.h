#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

#include "io/internal/descriptor.h"

namespace sunder::files {

/// The descriptor of this process to which a path leads: 1 for /dev/stdout, 3 for /dev/fd/3 and
/// /proc/self/fd/3.
[[nodiscard]] std::optional<int> own_descriptor(const std::filesystem::path& file);

/// Whether a folder is in /dev or /proc, where links are those of the system: /dev/mapper/root. The
/// files in /dev/shm are those of users.
[[nodiscard]] bool is_of_system(const std::filesystem::path& folder);

/// Opens a device or a FIFO for writing; a FIFO only if somebody reads it. With errno.
[[nodiscard]] Descriptor open_stream(int folder, const char* name);

/// Writes all bytes; waits where the reader is slow. A reader that has gone (EPIPE), and a limit of
/// the size of files (EFBIG), are errors instead of the end of the program.
/// @return false, with errno.
[[nodiscard]] bool write_all(int descriptor, std::span<const std::byte> bytes);

}  // namespace sunder::files
