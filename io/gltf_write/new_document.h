#pragma once

#include <sunder/io/character_bytes.h>

#include <cstddef>
#include <string>
#include <vector>

#include "io/internal/base_colours.h"

namespace sunder::gltf {

/// The GLB of a character without a source. Each bone becomes a node with the same index. A rigid
/// mesh whose bind matrix is the identity becomes a child of its bone's node; other meshes get a
/// node at the scene's root, and a skin.
/// @param materials  those to be copied; null: plain ones.
/// @throws Refusal  if the character or an option is not valid.
[[nodiscard]] std::vector<std::byte> new_document(const Character& character,
                                                  const SaveOptions& options,
                                                  const SourceDocument* materials);

/// The materials of a new document.
struct NewMaterials {
  BaseColours colours;
  std::vector<std::string> names;  ///< One per material.
};

/// The same with these materials:
/// Submesh::material is an index in them, or kNone for a plain one.
/// @throws Refusal  if the character is not valid.
[[nodiscard]] std::vector<std::byte> new_document(const Character& character,
                                                  const NewMaterials& materials);

}  // namespace sunder::gltf
