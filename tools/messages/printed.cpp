#include "tools/messages/printed.h"

#include <cstdarg>
#include <cstdio>

namespace sunder::tools {

std::string printed(const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int size = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string text(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  return text;
}

std::string point_text(const Vec3d& point) {
  return printed("(%.4g, %.4g, %.4g)", point.x(), point.y(), point.z());
}

}  // namespace sunder::tools
