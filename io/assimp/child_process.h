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
                                    << 30;  ///< Address space in addition to the parent's, bytes.
  std::uint64_t maximum_reply = std::uint64_t{2} << 30;  ///< Bytes accepted from the child.
};

/// The bytes that the child returns through the pipe.
struct ChildReply {
  std::string head;
  std::vector<std::byte> body;
};

/// Runs `work` in a forked child and returns its reply. The child has no open files except the
/// pipe, default signal handlers, no core dump, and may not write files. It is always reaped.
///
/// @param work  may crash, throw, hang or run out of memory; std::bad_alloc counts as the memory
///         limit.
/// @param name  of the file, for the error text.
/// @return limit_exceeded (time, memory, reply size, no process), malformed_file if the child
///         crashed, internal_error if it ended without a reply.
[[nodiscard]] Result<ChildReply> run_in_child(const std::function<ChildReply()>& work,
                                              const ChildLimits& limits, const std::string& name);

/// Whether this process is the child.
[[nodiscard]] bool is_import_child();

}  // namespace sunder::assimp_import
