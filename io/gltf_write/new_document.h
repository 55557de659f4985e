#pragma once

#include <sunder/io/character_file.h>

#include <cstddef>
#include <string>
#include <vector>

#include "io/internal/base_colours.h"

namespace sunder::gltf {

/// Implements save_glb() for characters without a source. Each bone becomes a node with the same
/// index. A rigid mesh whose bind matrix is the identity becomes a child of its bone's node; other
/// meshes get a node at the scene's root, and a skin.
[[nodiscard]] Status write_new_document(const std::filesystem::path& file,
                                        const Character& character, const SaveOptions& options);

/// Implements save_with_materials().
[[nodiscard]] Status write_with_materials(const std::filesystem::path& file,
                                          const Character& character,
                                          const SourceDocument& materials,
                                          const SaveOptions& options);

/// The materials of a new document.
struct NewMaterials {
  BaseColours colours;
  std::vector<std::string> names;  ///< One per material.
};

/// The bytes of the GLB that write_new_document() would write, but with these materials:
/// Submesh::material is an index in them, or kNone for a plain one.
/// @throws Refusal  if the character is not valid.
[[nodiscard]] std::vector<std::byte> new_document(const Character& character,
                                                  const NewMaterials& materials);

}  // namespace sunder::gltf
