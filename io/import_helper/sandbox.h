#pragma once

#include <array>
#include <cstdint>

namespace sunder::import_helper {

struct SandboxLimits {
  std::uint64_t memory = 0;          ///< Bytes beyond those in use.
  std::uint64_t largest_memory = 0;  ///< Up to which the caller may raise it.
  std::uint32_t cpu_seconds = 0;
};

/// Sets limits of this process for good: memory (not under sanitizers, which reserve terabytes),
/// CPU time, stack, open files, no core dump, no file grows, no new privileges, no tracing by other
/// processes of the user.
void set_limits(const SandboxLimits& limits);

/// Gives up what the caller's user may do: all capabilities and, for root, the user and its groups,
/// for those of `nobody`; then no process or thread can be started. Root stays, without
/// capabilities, where the system refuses the other user, or would not let the caller end its
/// processes (no CAP_KILL).
void drop_privileges();

/// Denies every access to files by path, and to TCP ports (Landlock), also where there is no filter
/// of system calls. Descriptors stay usable. Call it after set_limits().
/// @return whether the system has Landlock; false under sanitizers.
bool hide_files();

/// Text that says why there is no filter; empty: system calls are filtered.
using NoFilterReason = std::array<char, 120>;

/// Allows only the system calls that an import makes: memory, the time, reading open descriptors,
/// sending and receiving on import_messages::kSocket. Starting a program, process or thread,
/// tracing, and opening a socket end the process (SIGSYS); all other calls, such as opening a file,
/// fail with EPERM.
[[nodiscard]] NoFilterReason filter_system_calls();

}  // namespace sunder::import_helper
