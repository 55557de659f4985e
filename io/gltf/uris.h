#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sunder::gltf {

[[nodiscard]] bool is_data_uri(const std::string& uri);

/// The bytes of a base64 data: URI; other encodings are refused. `place` is for the error text.
[[nodiscard]] std::vector<std::byte> decode_data_uri(const std::string& uri,
                                                     const std::string& place);

}  // namespace sunder::gltf
