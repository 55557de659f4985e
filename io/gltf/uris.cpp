#include "io/gltf/uris.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include <tiny_gltf.h>

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

bool is_data_uri(const std::string& uri) { return uri.compare(0, 5, "data:") == 0; }

std::vector<std::byte> decode_data_uri(const std::string& uri, const std::string& place) {
  const std::size_t comma = uri.find(',');
  constexpr std::string_view kEncoding = ";base64";
  if (comma == std::string::npos || comma < kEncoding.size() ||
      uri.compare(comma - kEncoding.size(), kEncoding.size(), kEncoding) != 0)
    refuse(StatusCode::malformed_file, kNone, "%.120s: a data URI that is not base64",
           place.c_str());
  // tinygltf's decoder stops silently at the first character that is not base64.
  const std::size_t stop = uri.find_first_not_of(
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/", comma + 1);
  if (stop != std::string::npos && uri.find_first_not_of('=', stop) != std::string::npos)
    refuse(StatusCode::malformed_file, static_cast<std::uint32_t>(stop),
           "%.120s: character %zu is not base64", place.c_str(), stop);
  std::vector<unsigned char> decoded;
  std::string mime_type;
  // The decoder supports only some media types and fails on an empty payload, so pass the type that
  // glTF prescribes.
  tinygltf::DecodeDataURI(&decoded, mime_type,
                          "data:application/octet-stream;base64," + uri.substr(comma + 1), 0,
                          false);
  std::vector<std::byte> bytes(decoded.size());
  if (!decoded.empty()) std::memcpy(bytes.data(), decoded.data(), decoded.size());
  return bytes;
}

std::filesystem::path resolve_uri(const std::string& uri, const std::filesystem::path& folder,
                                  const std::string& place,
                                  const std::vector<std::filesystem::path>& roots) {
  const auto refuse_path = [&](const char* why) {
    refuse(StatusCode::path_not_allowed, kNone, "%.80s: '%.80s' %s", place.c_str(), uri.c_str(),
           why);
  };
  if (folder.empty()) refuse_path("refers to another file, which is not allowed here");
  const std::string decoded = percent_decoded(uri);
  if (decoded.empty() || decoded.find('\0') != std::string::npos) refuse_path("is not a file name");
  if (has_scheme(decoded)) refuse_path("is not a relative path");
  const std::filesystem::path relative = std::filesystem::u8path(decoded);
  if (relative.is_absolute() || relative.has_root_directory())
    refuse_path("is not a relative path");

  std::error_code error;
  std::vector<std::filesystem::path> allowed = {std::filesystem::canonical(folder, error)};
  if (error)
    refuse(StatusCode::file_not_found, kNone, "%.80s: the model's folder cannot be opened",
           place.c_str());
  for (const auto& root : roots)
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

std::vector<std::byte> read_uri(const std::string& uri, const std::filesystem::path& folder,
                                const std::string& place,
                                const std::vector<std::filesystem::path>& roots,
                                std::uint64_t maximum_bytes) {
  const std::filesystem::path file = resolve_uri(uri, folder, place, roots);
  return content_of(files::open_checked_file(file), file, maximum_bytes, place);
}

std::vector<std::byte> read_file(const std::filesystem::path& file, std::uint64_t maximum_bytes,
                                 const std::string& place) {
  return content_of(files::open_regular_file(file), file, maximum_bytes, place);
}

}  // namespace sunder::gltf
