#include "tools/messages/written_file.h"

#include <system_error>

#include "tools/messages/printed.h"

namespace sunder::tools {

std::string written(const std::filesystem::path& file) {
  std::error_code error;
  const auto bytes = static_cast<double>(std::filesystem::file_size(file, error));
  const std::string place = "wrote " + file.string();
  if (error) return place;  // A device has no size.
  if (bytes < 1e3) return place + printed(", %.0f bytes", bytes);
  return place +
         (bytes < 1e6 ? printed(", %.0f kB", bytes / 1e3) : printed(", %.1f MB", bytes / 1e6));
}

}  // namespace sunder::tools
