#include "io/gltf_files/folder_files.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

#include "io/files/allowed_files.h"
#include "io/files/read_file.h"
#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decoded(const std::string& uri) {
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 &&
        hex_digit(uri[i + 2]) >= 0) {
      decoded.push_back(static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2])));
      i += 2;
    } else {
      decoded.push_back(uri[i]);
    }
  }
  return decoded;
}

bool has_scheme(const std::string& path) {
  const std::size_t colon = path.find(':');
  return colon != std::string::npos && path.find_first_of("/\\") >= colon;
}

bool is_inside(const std::filesystem::path& file, const std::filesystem::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
         folder.end();
}

/// The content of an opened file, whose type and size are those of the descriptor.
std::vector<std::byte> content_of(const Result<files::OpenFile>& opened,
                                  const std::filesystem::path& file, std::uint64_t maximum_bytes,
                                  const std::string& place) {
  const std::string name = file.filename().string();
  if (!opened)
    refuse(opened.error().code(), kNone, "%.120s: %.130s", place.c_str(),
           std::string(opened.error().text()).c_str());
  const std::uint64_t size = opened->bytes;
  if (size > maximum_bytes)
    refuse(StatusCode::limit_exceeded, kNone,
           "%.80s: '%.80s' has %llu bytes; %llu are left of LoadOptions::maximum_bytes",
           place.c_str(), name.c_str(), static_cast<unsigned long long>(size),
           static_cast<unsigned long long>(maximum_bytes));
  Result<std::vector<std::byte>> bytes = files::read_all(*opened, maximum_bytes);
  if (!bytes)
    refuse(bytes.error().code(), kNone, "%.120s: '%.100s': %.100s", place.c_str(), name.c_str(),
           std::string(bytes.error().text()).c_str());
  return std::move(*bytes);
}

}  // namespace

FolderFiles::FolderFiles(const std::filesystem::path& folder,
                         const std::vector<std::filesystem::path>& roots)
    : folder_(std::filesystem::absolute(folder)) {
  for (const auto& root : roots) roots_.push_back(std::filesystem::absolute(root));
}

std::filesystem::path FolderFiles::resolve(const std::string& uri, const std::string& place) const {
  const auto refuse_path = [&](const char* why) {
    refuse(StatusCode::path_not_allowed, kNone, "%.80s: '%.80s' %s", place.c_str(), uri.c_str(),
           why);
  };
  const std::string decoded = percent_decoded(uri);
  if (decoded.empty() || decoded.find('\0') != std::string::npos) refuse_path("is not a file name");
  if (has_scheme(decoded)) refuse_path("is not a relative path");
  const std::filesystem::path relative = std::filesystem::u8path(decoded);
  if (relative.is_absolute() || relative.has_root_directory())
    refuse_path("is not a relative path");

  std::error_code error;
  std::vector<std::filesystem::path> allowed = {std::filesystem::canonical(folder_, error)};
  if (error)
    refuse(StatusCode::file_not_found, kNone, "%.80s: the model's folder cannot be opened",
           place.c_str());
  for (const auto& root : roots_)
    if (auto whole = std::filesystem::canonical(root, error); !error)
      allowed.push_back(std::move(whole));
  std::filesystem::path first;
  bool is_outside = false;
  for (const auto& root : allowed) {
    auto file = std::filesystem::weakly_canonical(root / relative, error);
    if (error) continue;
    if (std::none_of(allowed.begin(), allowed.end(),
                     [&](const auto& one) { return is_inside(file, one); }))
      is_outside = true;
    else if (std::filesystem::exists(file, error))
      return file;
    else if (first.empty())
      first = std::move(file);
  }
  if (is_outside) refuse_path("is outside the model's folder (LoadOptions::roots)");
  if (first.empty())
    refuse(StatusCode::file_unreadable, kNone, "%.80s: '%.80s' cannot be resolved", place.c_str(),
           uri.c_str());
  return first;
}

std::vector<std::byte> FolderFiles::read(const std::string& uri, const std::string& place,
                                         std::uint64_t maximum_bytes) const {
  const std::filesystem::path file = resolve(uri, place);
  return content_of(files::open_checked_file(file), file, maximum_bytes, place);
}

bool FolderFiles::exists(const std::string& uri, const std::string& place) const {
  std::error_code error;
  return std::filesystem::is_regular_file(resolve(uri, place), error);
}

std::vector<std::byte> read_file(const std::filesystem::path& file, std::uint64_t maximum_bytes,
                                 const std::string& place) {
  return content_of(files::open_regular_file(file), file, maximum_bytes, place);
}

}  // namespace sunder::gltf
