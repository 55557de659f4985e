#pragma once

#include <sunder/core/status.h>

#include <new>
#include <sunder_c.h>

namespace sunder::c {

/// Keeps the failure for sunder_last_error(). @return its status.
SUNDER_PRINTF(3, 4)
sunder_status fail(sunder_status status, std::uint32_t index, const char* format, ...);

/// SUNDER_OK, or keeps the failure.
sunder_status report(const Status& status);

sunder_status null_pointer(const char* name);

/// Runs the body of a call; no exception leaves it.
template <class Body>
sunder_status guarded(Body&& body) noexcept {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return fail(SUNDER_LIMIT_EXCEEDED, kNone, "out of memory");
  } catch (const std::exception& error) {
    return fail(SUNDER_INTERNAL_ERROR, kNone, "%s", error.what());
  } catch (...) {
    return fail(SUNDER_INTERNAL_ERROR, kNone, "an exception of another kind");
  }
}

}  // namespace sunder::c
