#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "io/gltf/cursor.h"

namespace sunder::gltf {

struct JsonLimits {
  std::size_t levels = 0;   ///< Of nested arrays and objects.
  std::size_t members = 0;  ///< Of one object.
  /// Bytes of the parsed document, about: its text, 32 per comma, 80 per array and object.
  std::uint64_t memory = std::numeric_limits<std::uint64_t>::max();
};

/// Parses well-formed JSON by simdjson, several times faster than nlohmann's parser, with the same
/// result.
/// @return nothing for all that exceeds a limit, is malformed, or is rare enough to be left to
/// nlohmann's parser, such as an object that names a member twice.
[[nodiscard]] std::optional<Json> parse_json_fast(std::string_view text, const JsonLimits& limits);

}  // namespace sunder::gltf
