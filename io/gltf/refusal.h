#pragma once

#include <sunder/core/status.h>

namespace sunder::gltf {

/// How code inside io/gltf gives up on a file: thrown where the fault is found, turned into its
/// Status at the doors (read_character, save), never seen outside. Reading is all or nothing, so
/// nobody in between has anything to add.
struct Refusal {
  Status status;
};

[[noreturn]] void refuse(StatusCode code, std::uint32_t index, const char* format, ...)
    __attribute__((format(printf, 3, 4)));

/// Runs `work` and turns whatever it or a third party throws into a Status.
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
