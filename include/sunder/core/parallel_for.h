#pragma once

#include <cstdint>

namespace sunder {

/// A hook into the host's job system, by which a call spreads its work over threads. Without a hook
/// the calling thread does all the work. Results have the same bits with every hook.
struct ParallelFor {
  using Task = void (*)(const void* work, std::uint32_t index);

  /// Calls task(work, i) once for each i < count, on any threads and in any order, and returns when
  /// all calls have returned. Tasks neither throw nor allocate, nor call this hook.
  void (*run)(void* context, std::uint32_t count, Task task, const void* work) = nullptr;
  void* context = nullptr;    ///< Handed to `run`.
  std::uint32_t threads = 1;  ///< Threads behind `run`; work is cut into a few tasks per thread.
};

}  // namespace sunder
