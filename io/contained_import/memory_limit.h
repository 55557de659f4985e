#pragma once

#include <sunder/io/character_file.h>

#include <cstdint>
#include <sys/types.h>

namespace sunder::contained_import {

/// The memory that an import of files of `bytes` bytes may use: 256 MiB, or 64 bytes per byte of
/// the files if that is more, but at most options.import_memory.
[[nodiscard]] std::uint64_t import_memory_of(std::uint64_t bytes, const LoadOptions& options);

/// Whether raise_memory_limit() works for a helper. Root's helpers run as another user, whose
/// limits root can change with CAP_SYS_RESOURCE only; many containers lack it.
[[nodiscard]] bool can_raise_memory_limit();

/// Raises the limits of a process's memory, within the largest ones that it may have.
void raise_memory_limit(pid_t process, std::uint64_t by);

}  // namespace sunder::contained_import
