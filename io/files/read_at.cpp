#include "io/files/read_at.h"

#include <algorithm>
#include <cerrno>
#include <unistd.h>

namespace sunder::files {

std::size_t read_at(const Descriptor& descriptor, void* target, std::size_t bytes,
                    std::size_t offset) {
  std::size_t have = 0;
  while (have < bytes) {
    const ssize_t got =
        pread(descriptor.value(), static_cast<char*>(target) + have,
              std::min(bytes - have, std::size_t{1} << 30), static_cast<off_t>(offset + have));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    have += static_cast<std::size_t>(got);
  }
  return have;
}

}  // namespace sunder::files
