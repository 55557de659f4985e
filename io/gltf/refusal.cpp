#include "io/gltf/refusal.h"

#include <cstdarg>
#include <cstdio>
#include <exception>
#include <new>

namespace sunder::gltf {

void refuse(StatusCode code, std::uint32_t index, const char* format, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  throw Refusal{Status::failure(code, index, "%s", text)};
}

Status status_of_current_exception() {
  try {
    throw;
  } catch (const Refusal& refusal) {
    return refusal.status;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  } catch (const std::exception& error) {
    return Status::failure(StatusCode::internal_error, kNone, "unexpected exception: %s",
                           error.what());
  } catch (...) {
    return Status::failure(StatusCode::internal_error, kNone, "unexpected exception");
  }
}

}  // namespace sunder::gltf
