#pragma once

#include <sunder/core/character.h>

#include <span>
#include <vector>

#include "io/gltf/glb.h"

namespace sunder::gltf {

/// A bone as a node: name and rest transform, no children.
[[nodiscard]] Json bone_node(const Bone& bone);

/// Appends the inverse bind matrices of a skin. @return their accessor.
std::uint32_t add_bind_matrices(GlbDraft& draft, const Skin& skin);

/// Appends a skin with its inverse bind matrices. @return its index in /skins.
/// @param node_of_bone  per bone of the skeleton.
std::uint32_t add_skin(GlbDraft& draft, const Skin& skin,
                       std::span<const std::uint32_t> node_of_bone);

/// Bones and skins that a character has in addition to the document it came from.
class AppendedRig {
 public:
  /// Appends nodes for the bones from `first_bone` on. Roots get a common parent in the scene, for
  /// glTF wants the joints of a skin below one root.
  AppendedRig(GlbDraft& draft, const Character& character, const SourceDocument& source,
              std::uint32_t first_bone);

  /// The glTF skin of a skin of the character, appended when it is first asked for.
  std::uint32_t skin(std::uint32_t index);

  /// Per bone of the character, appended ones too; kNone for bones without a node.
  [[nodiscard]] std::span<const std::uint32_t> node_of_bone() const { return node_of_bone_; }

 private:
  void add_to_scene(const std::vector<std::uint32_t>& roots);

  GlbDraft& draft_;
  const Character& character_;
  std::vector<std::uint32_t> node_of_bone_;
  std::vector<std::uint32_t> gltf_skin_of_;
};

}  // namespace sunder::gltf
