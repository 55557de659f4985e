#pragma once

#include <sunder/io/character_file.h>

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

}  // namespace sunder::gltf
