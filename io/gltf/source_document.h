#pragma once

#include <sunder/io/character_file.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/gltf/cursor.h"

namespace sunder {

/// A loaded glTF as it was, and which of its parts each core mesh came from. Does not change after
/// loading.
class SourceDocument {
 public:
  struct MeshOrigin {
    std::uint32_t node = kNone;
    std::uint32_t mesh = kNone;  ///< In /meshes.
    std::vector<std::uint32_t>
        primitives;  ///< Indices in /meshes/<mesh>/primitives, one per submesh.
    std::vector<std::uint32_t> color_components;  ///< 3 or 4, one a colour set.
    bool skinned =
        false;  ///< false: its skin is the node alone, and the file has no weights for it.
    bool repaired = false;  ///< The loaded mesh differs from the file, which therefore must not be
                            ///< written again.
  };

  SourceDocument() = default;
  SourceDocument(const SourceDocument&) = delete;
  SourceDocument& operator=(const SourceDocument&) = delete;

  gltf::Json json;
  std::vector<std::byte> content;                   ///< The file's own bytes.
  bool is_glb = false;                              ///< `content` is a GLB, not text.
  std::vector<std::vector<std::byte>> other_files;  ///< Bytes of data: URIs and external buffers.
  std::vector<std::span<const std::byte>>
      buffers;                   ///< One an entry of /buffers, in `content` or `other_files`.
  std::filesystem::path folder;  ///< Absolute, or empty: where relative URIs may point.
  std::uint64_t maximum_bytes =
      0;  ///< LoadOptions::maximum_bytes, for the images that saving embeds.
  std::vector<MeshOrigin> mesh_origins;     ///< One a mesh of the character.
  std::vector<std::uint32_t> node_of_bone;  ///< kNone for bones that loading added.
};

}  // namespace sunder
