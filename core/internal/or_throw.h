#pragma once

#include <sunder/core/status.h>

#include <new>
#include <utility>

namespace sunder {

/// The value of a call that can only run out of memory. Public functions turn
/// the exception into a status again: or_out_of_memory().
/// @throws std::bad_alloc
template <class T>
[[nodiscard]] T or_throw(Result<T> result) {
  if (!result) throw std::bad_alloc();
  return std::move(*result);
}
inline void or_throw(const Status& status) {
  if (!status) throw std::bad_alloc();
}

}  // namespace sunder
