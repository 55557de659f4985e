#pragma once

#include <sunder/core/memory_scope.h>
#include <sunder/core/status.h>

#include <new>
#include <stdexcept>
#include <sunder_c.h>

#include "bindings/c/allocator.h"

namespace sunder::c {

/// Keeps the failure for sunder_last_error(). @return its status.
SUNDER_PRINTF(3, 4)
sunder_status fail(sunder_status status, std::uint32_t index, const char* format, ...);

/// SUNDER_OK, or keeps the failure.
sunder_status report(const Status& status);

sunder_status null_pointer(const char* name);

/// Refuses a size that exceeds the memory of the platform: where that has 32 bits, it would count
/// as a small one.
sunder_status check_size(std::uint64_t size, const char* name);

/// Runs the body of a call, which allocates from the caller's allocator; no exception leaves it.
template <class Body>
sunder_status guarded(Body&& body) noexcept {
  const MemoryScope scope(allocator());
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return fail(SUNDER_LIMIT_EXCEEDED, kNone, "out of memory");
  } catch (const std::length_error&) {  // of a vector that no memory of this platform can hold
    return fail(SUNDER_LIMIT_EXCEEDED, kNone, "out of memory");
  } catch (const std::exception& error) {
    return fail(SUNDER_INTERNAL_ERROR, kNone, "%s", error.what());
  } catch (...) {
    return fail(SUNDER_INTERNAL_ERROR, kNone, "an exception of another kind");
  }
}

}  // namespace sunder::c
