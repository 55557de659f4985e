#pragma once

#include <sunder/io/character_file.h>

namespace sunder::gltf {

/// See the save_glb() for characters without a source. A bone becomes a node of the same number; a
/// rigid mesh whose bind is the identity hangs on its bone's node; other meshes get a node at the
/// scene's root and a skin.
[[nodiscard]] Status write_new_document(const std::filesystem::path& file,
                                        const Character& character, const SaveOptions& options);

}  // namespace sunder::gltf
