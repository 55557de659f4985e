#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sunder::gltf {

[[nodiscard]] bool is_data_uri(const std::string& uri);

/// The bytes of a base64 data: URI; other encodings are refused. `place` is for the error text.
[[nodiscard]] std::vector<std::byte> decode_data_uri(const std::string& uri,
                                                     const std::string& place);

/// The file that a relative URI names: in `folder`, else in the first of `roots` that has it.
/// Refuses (path_not_allowed) absolute paths, other schemes, and files that, after links are
/// resolved, are neither in `folder` nor in one of the roots or below.
[[nodiscard]] std::filesystem::path resolve_uri(
    const std::string& uri, const std::filesystem::path& folder, const std::string& place,
    const std::vector<std::filesystem::path>& roots = {});

/// The bytes of the regular file that resolve_uri() finds. The file that was checked is the one
/// that is read: a part of its path that has become a link since is refused. Refuses a file larger
/// than `maximum_bytes`.
[[nodiscard]] std::vector<std::byte> read_uri(const std::string& uri,
                                              const std::filesystem::path& folder,
                                              const std::string& place,
                                              const std::vector<std::filesystem::path>& roots,
                                              std::uint64_t maximum_bytes);

/// The bytes of a regular file that the caller names. Refuses a file that is missing, unreadable or
/// larger than `maximum_bytes`.
[[nodiscard]] std::vector<std::byte> read_file(const std::filesystem::path& file,
                                               std::uint64_t maximum_bytes,
                                               const std::string& place);

}  // namespace sunder::gltf
