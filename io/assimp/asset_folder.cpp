#include "io/assimp/asset_folder.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

namespace sunder::assimp_import {

namespace fs = std::filesystem;

AssetFolder::AssetFolder(const fs::path& folder, std::uint64_t maximum_bytes)
    : budget_(maximum_bytes) {
  std::error_code error;
  folder_ = fs::canonical(folder, error);
}

Result<fs::path> AssetFolder::resolve(std::string_view reference) const {
  std::string text(reference.substr(0, reference.find('\0')));
  std::replace(text.begin(), text.end(), '\\', '/');
  std::error_code error;
  const fs::path file =
      fs::weakly_canonical(folder_ / text, error);  // If `text` is absolute, the folder is ignored.
  if (error || folder_.empty())
    return Status::failure(StatusCode::file_not_found, kNone, "no file '%s'", text.c_str());
  const auto [end_of_folder, rest] =
      std::mismatch(folder_.begin(), folder_.end(), file.begin(), file.end());
  if (end_of_folder != folder_.end())
    return Status::failure(StatusCode::path_not_allowed, kNone,
                           "'%s' is outside the model's own folder", text.c_str());
  if (!fs::is_regular_file(file, error) || error)
    return Status::failure(StatusCode::file_not_found, kNone, "no file '%s'", text.c_str());
  return file;
}

Status AssetFolder::charge(const fs::path& file) {
  if (charged_.contains(file)) return {};
  std::error_code error;
  const std::uint64_t bytes = fs::file_size(file, error);
  if (error || bytes > budget_)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "'%s' and what it refers to exceed the size limit",
                           file.filename().c_str());
  budget_ -= bytes;
  charged_.insert(file);
  return {};
}

std::optional<std::vector<std::byte>> AssetFolder::read(std::string_view reference) {
  const Result<fs::path> file = resolve(reference);
  if (!file || !charge(*file)) return std::nullopt;
  std::ifstream stream(*file, std::ios::binary | std::ios::ate);
  const auto size = stream.tellg();
  if (!stream || size < 0) return std::nullopt;
  std::vector<std::byte> content(static_cast<std::size_t>(size));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(content.data()), size);
  if (!stream) return std::nullopt;
  return content;
}

}  // namespace sunder::assimp_import
