#pragma once

#include <cstdint>

namespace sunder {

/// How a call may spread its work over the host's threads: a hook into a job system. The default
/// does all of it where it is called. Results are the same bits, whatever the hook does.
struct ParallelFor {
  using Task = void (*)(const void* work, std::uint32_t index);

  /// Calls task(work, i) once for each i < count, on any threads and in any order, and returns when
  /// all calls have returned. Tasks neither throw nor allocate, nor call this hook.
  void (*run)(void* context, std::uint32_t count, Task task, const void* work) = nullptr;
  void* context = nullptr;    ///< Handed to `run`.
  std::uint32_t threads = 1;  ///< That work at once; work is cut into a few tasks for each.
};

}  // namespace sunder
