#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sunder::gltf {

[[nodiscard]] bool is_data_uri(const std::string& uri);

/// The bytes of a base64 data: URI. Refuses another encoding. `place` names it in the refusal.
[[nodiscard]] std::vector<std::byte> decode_data_uri(const std::string& uri,
                                                     const std::string& place);

/// The file that a relative URI means. Refuses (path_not_allowed) absolute paths, other schemes and
/// whatever, after following links, does not lie in `folder` or below.
[[nodiscard]] std::filesystem::path resolve_uri(const std::string& uri,
                                                const std::filesystem::path& folder,
                                                const std::string& place);

/// A regular file's bytes; refuses one that is missing, unreadable or larger than `maximum_bytes`.
[[nodiscard]] std::vector<std::byte> read_file(const std::filesystem::path& file,
                                               std::uint64_t maximum_bytes,
                                               const std::string& place);

}  // namespace sunder::gltf
