#include "io/gltf/uris.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "io/gltf/refusal.h"
#include "io/gltf/side_files.h"

namespace sunder::gltf {
namespace {

constexpr std::string_view kBase64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::uint8_t, 256> base64_values() {
  std::array<std::uint8_t, 256> values{};
  for (std::size_t i = 0; i < kBase64.size(); ++i)
    values[static_cast<unsigned char>(kBase64[i])] = static_cast<std::uint8_t>(i);
  return values;
}

/// @param text  characters of kBase64 only, without padding. Bits that fill no byte are left out.
std::vector<std::byte> decode_base64(std::string_view text) {
  static constexpr std::array<std::uint8_t, 256> kValues = base64_values();
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    bits = bits << 6u | kValues[static_cast<unsigned char>(c)];
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> count & 0xFFu));
  }
  return bytes;
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
  const std::string_view text = std::string_view(uri).substr(comma + 1);
  const std::size_t stop = std::min(text.find_first_not_of(kBase64), text.size());
  if (text.find_first_not_of('=', stop) != std::string_view::npos)
    refuse(StatusCode::malformed_file, static_cast<std::uint32_t>(comma + 1 + stop),
           "%.120s: character %zu is not base64", place.c_str(), comma + 1 + stop);
  return decode_base64(text.substr(0, stop));
}

void refuse_side_file(const std::string& uri, const std::string& place) {
  refuse(StatusCode::path_not_allowed, kNone,
         "%.80s: '%.80s' refers to another file, which is not allowed here", place.c_str(),
         uri.c_str());
}

}  // namespace sunder::gltf
