#pragma once

#include <sunder/io/character_bytes.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/gltf/cursor.h"
#include "io/gltf/file_identity.h"
#include "io/gltf/side_files.h"

namespace sunder {

/// A loaded glTF document as it was, and the parts of it from which each mesh was read. Immutable
/// after loading.
class SourceDocument {
 public:
  struct MeshOrigin {
    std::uint32_t node = kNone;
    std::uint32_t mesh = kNone;  ///< In /meshes.
    /// Indices in /meshes/<mesh>/primitives, one per submesh.
    std::vector<std::uint32_t> primitives;
    std::vector<std::uint32_t> color_components;  ///< 3 or 4, one per colour set.
    bool skinned = false;   ///< false: the skin is the node alone, and the file has no weights.
    bool repaired = false;  ///< The loaded mesh differs from the file, so saving must write it.
  };

  SourceDocument() = default;
  SourceDocument(const SourceDocument&) = delete;
  SourceDocument& operator=(const SourceDocument&) = delete;

  /// A skin whose inverse bind matrices differ from the file's, so saving must write them.
  struct RepairedSkin {
    std::uint32_t gltf_skin = 0;  ///< In /skins.
    std::uint32_t skin = 0;       ///< In Character::skins.
  };

  /// @throws Refusal  as SideFiles::read(); also if it may refer to no other file.
  [[nodiscard]] std::vector<std::byte> read_side_file(const std::string& uri,
                                                      const std::string& place,
                                                      std::uint64_t most_bytes) const {
    if (side_files == nullptr) gltf::refuse_side_file(uri, place);
    return side_files->read(uri, place, most_bytes);
  }

  /// As in the file; where the file compresses data, as it would be without compression.
  gltf::Json json;
  std::vector<std::byte> content;  ///< The bytes of a GLB.
  bool is_glb = false;
  gltf::FileIdentity text_identity;  ///< Of a text, of which `content` has nothing.
  std::vector<std::vector<std::byte>>
      other_files;  ///< Content of data: URIs and external buffers; decoded data.
  /// One per entry of /buffers, in `content` or `other_files`; empty where nothing refers to it.
  std::vector<std::span<const std::byte>> buffers;
  std::shared_ptr<const gltf::SideFiles> side_files;  ///< Null: it may refer to no other file.
  std::uint64_t maximum_bytes = 0;   ///< ReadOptions::maximum_bytes, for images embedded on saving.
  std::uint64_t maximum_memory = 0;  ///< For decoded data, as ReadOptions::maximum_memory; not 0.
  std::vector<MeshOrigin> mesh_origins;  ///< One per mesh of the character.
  std::vector<RepairedSkin> repaired_skins;
  std::vector<std::uint32_t> node_of_bone;  ///< kNone for bones that loading added.
};

}  // namespace sunder
