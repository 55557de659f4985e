#pragma once

#include <sunder/core/api.h>
#include <sunder/core/status.h>

namespace sunder::gltf {

/// The failure of code in io/gltf: thrown where the fault is found, and converted to a Status at
/// the entry points (read_character, save). It never leaves io/gltf. Reading either succeeds
/// completely or fails, so no code in between needs to handle it.
struct Refusal {
  Status status;
};

[[noreturn]] void refuse(StatusCode code, std::uint32_t index, const char* format, ...)
    SUNDER_PRINTF(3, 4);

/// Runs `work` and converts any exception to a Status.
template <class T, class Work>
Result<T> without_exceptions(Work&& work);

/// The Status of the exception that is being handled.
Status status_of_current_exception();

template <class T, class Work>
Result<T> without_exceptions(Work&& work) {
  try {
    return work();
  } catch (...) {
    return status_of_current_exception();
  }
}

}  // namespace sunder::gltf
