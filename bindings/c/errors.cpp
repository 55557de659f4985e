#include "bindings/c/errors.h"

#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>

namespace sunder::c {
namespace {

struct LastError {
  char text[256] = {};
  std::uint32_t index = kNone;
};

thread_local LastError last_error;

}  // namespace

sunder_status fail(sunder_status status, std::uint32_t index, const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(last_error.text, sizeof last_error.text, format, arguments);
  va_end(arguments);
  last_error.index = index;
  return status;
}

sunder_status report(const Status& status) {
  if (status) return SUNDER_OK;
  return fail(static_cast<sunder_status>(status.code()), status.index(), "%.*s",
              static_cast<int>(status.text().size()), status.text().data());
}

sunder_status null_pointer(const char* name) {
  return fail(SUNDER_NULL_POINTER, kNone, "`%s` is null", name);
}

sunder_status check_size(std::uint64_t size, const char* name) {
  if (size <= std::numeric_limits<std::size_t>::max() / 2) return SUNDER_OK;
  return fail(SUNDER_LIMIT_EXCEEDED, kNone, "`%s` is %llu bytes, more than memory can hold", name,
              static_cast<unsigned long long>(size));
}

}  // namespace sunder::c

extern "C" {

const char* sunder_last_error(void) { return sunder::c::last_error.text; }

uint32_t sunder_last_error_index(void) { return sunder::c::last_error.index; }

const char* sunder_status_name(sunder_status status) {
  if (status == SUNDER_INVALID_HANDLE) return "invalid_handle";
  if (status == SUNDER_INVALID_STRUCT) return "invalid_struct";
  if (status == SUNDER_NULL_POINTER) return "null_pointer";
  if (status < SUNDER_OK || status > SUNDER_INTERNAL_ERROR) return "unknown";
  return sunder::status_name(static_cast<sunder::StatusCode>(status)).data();
}

}  // extern "C"
