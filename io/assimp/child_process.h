#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace sunder::assimp_import {

struct ChildLimits {
  double seconds = 120.0;  ///< Wall clock, and CPU time rounded up. > 0.
  std::uint64_t additional_memory = std::uint64_t{4}
                                    << 30;  ///< Address space beyond what the parent has, bytes.
  std::uint64_t maximum_reply = std::uint64_t{2} << 30;  ///< Bytes accepted from the child.
};

/// The bytes that the child returns through the pipe.
struct ChildReply {
  std::string head;
  std::vector<std::byte> body;
};

/// Runs `work` in a forked child and returns its reply. The child has no open files but the pipe,
/// default signal handlers, no core dump, and may not write files; it is always reaped.
///
/// @param work   may crash, throw, hang or run out of memory; std::bad_alloc counts as the memory
/// limit.
/// @param name   of what is worked on, for the text.
/// @return limit_exceeded (time, memory, reply size, no process to be had), malformed_file where
/// the child crashed, internal_error
///         where it ended without a reply.
[[nodiscard]] Result<ChildReply> run_in_child(const std::function<ChildReply()>& work,
                                              const ChildLimits& limits, const std::string& name);

/// True in the child, from its first moment on.
[[nodiscard]] bool is_import_child();

}  // namespace sunder::assimp_import
