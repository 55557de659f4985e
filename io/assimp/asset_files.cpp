#include "io/assimp/asset_files.h"

#include <algorithm>
#include <cerrno>
#include <unistd.h>

namespace sunder::assimp_import {

std::size_t read_at(const files::Descriptor& descriptor, void* target, std::size_t bytes,
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

std::optional<std::vector<std::byte>> AssetFiles::read(std::string_view reference) {
  const Result<files::OpenFile> file = open(reference);
  if (!file) return std::nullopt;
  std::vector<std::byte> content(file->bytes);
  if (read_at(file->descriptor, content.data(), content.size(), 0) != content.size())
    return std::nullopt;
  return content;
}

}  // namespace sunder::assimp_import
