#pragma once

#include "io/gltf/decoders.h"

namespace sunder::gltf {

/// Decoders::json, by simdjson.
[[nodiscard]] std::optional<Json> parse_json_fast(std::string_view text, const JsonLimits& limits);

}  // namespace sunder::gltf
