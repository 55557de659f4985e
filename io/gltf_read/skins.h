#pragma once

#include <sunder/core/skin.h>

#include <vector>

#include "io/gltf_read/reading.h"
#include "io/gltf_read/skeleton.h"

namespace sunder::gltf {

/// Creates the character's skins when meshes first request them: one per glTF skin or rigid node.
class SkinReader {
 public:
  SkinReader(Reading& reading, const NodeSkeleton& nodes, std::vector<Skin>& skins);

  ///
  /// @return index in the character's skins.
  std::uint32_t of_skin(std::uint32_t gltf_skin);
  /// Skins of the file whose inverse bind matrices were corrected.
  [[nodiscard]] const std::vector<SourceDocument::RepairedSkin>& repaired() const {
    return repaired_;
  }
  std::uint32_t of_node(std::uint32_t node);
  /// The slot for vertices without influences: the skin's `skeleton` node if that is a joint,
  /// otherwise its first joint.
  [[nodiscard]] std::uint32_t root_slot(std::uint32_t gltf_skin) const;

 private:
  Skin read_skin(const Cursor& at, std::uint32_t gltf_skin);

  Reading& reading_;
  const NodeSkeleton& nodes_;
  std::vector<Skin>& skins_;
  std::vector<std::uint32_t> from_gltf_skin_;
  std::vector<std::uint32_t> from_node_;
  std::vector<SourceDocument::RepairedSkin> repaired_;
};

}  // namespace sunder::gltf
