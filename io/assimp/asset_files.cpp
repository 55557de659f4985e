#include "io/assimp/asset_files.h"

#include "io/files/read_at.h"

namespace sunder::assimp_import {

std::optional<std::vector<std::byte>> AssetFiles::read(std::string_view reference) {
  const Result<files::OpenFile> file = open(reference);
  if (!file) return std::nullopt;
  std::vector<std::byte> content(file->bytes);
  if (files::read_at(file->descriptor, content.data(), content.size(), 0) != content.size())
    return std::nullopt;
  return content;
}

}  // namespace sunder::assimp_import
