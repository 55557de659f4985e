#pragma once

#include <sunder/core/status.h>

#include <new>

namespace sunder {

/// The status of a call that caught std::bad_alloc. Does not allocate.
[[nodiscard]] inline Status out_of_memory() {
  return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
}

/// Runs the body of a public function. @param work  returns a Status or a Result; before it throws,
/// it leaves everything as it was.
/// @return that, or out_of_memory() if it throws std::bad_alloc.
template <class Work>
[[nodiscard]] auto or_out_of_memory(Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

}  // namespace sunder
