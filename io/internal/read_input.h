#pragma once

#include <sunder/core/status.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

namespace sunder {

/// How long a pipe may take to its end.
constexpr std::chrono::milliseconds kPatienceWithPipes = std::chrono::seconds(60);

/// Reads a whole text: a regular file, or a pipe, such as /dev/stdin and the <(…) of shells. It is
/// opened once, without waiting, and what was opened is checked, so that no folder, device or
/// socket is read. A pipe is waited for, but no longer than `patience` in all. Allocates.
/// @return file_not_found; file_unreadable: also for anything else than a file or a pipe, and for a
///         pipe that does not end in time; limit_exceeded above `maximum_bytes`. Texts name the
///         file. Out of memory: throws std::bad_alloc.
[[nodiscard]] SUNDER_API Result<std::string> read_input(
    const std::filesystem::path& file, std::uint64_t maximum_bytes,
    std::chrono::milliseconds patience = kPatienceWithPipes);

}  // namespace sunder
