#pragma once

#include <sunder/core/status.h>

#include <new>
#include <utility>

namespace sunder::tools {

/// The value of a call that fails for want of memory alone. main() reports that.
/// @throws std::bad_alloc
template <class T>
[[nodiscard]] T value_of(Result<T> result) {
  if (!result) throw std::bad_alloc();
  return std::move(*result);
}

}  // namespace sunder::tools
