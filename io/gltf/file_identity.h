#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace sunder {
class SourceDocument;
}

namespace sunder::gltf {

/// Identifies the content of a file.
struct FileIdentity {
  std::uint64_t bytes = 0;  ///< Size.
  std::string sha256;       ///< Of the content, as sha256sum prints it.
};

[[nodiscard]] FileIdentity identity_of(std::span<const std::byte> content);

/// The identity of the GLB or glTF text that was read, without files to which it refers.
[[nodiscard]] FileIdentity identity_of(const SourceDocument& document);

}  // namespace sunder::gltf
