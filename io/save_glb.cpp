#include <sunder/io/character_file.h>

#include "io/gltf/source_document.h"
#include "io/gltf_patch/write.h"
#include "io/gltf_write/new_document.h"
#include "io/internal/copied_materials.h"
#include "io/internal/mesh_nodes.h"

namespace sunder {

Status save_glb(const std::filesystem::path& file, const Character& character,
                const LoadedCharacter& loaded, const SaveOptions& options) {
  return gltf::write_character(file, character, loaded, options);
}

Result<std::vector<WrittenInfluences>> written_influences(const Character& character,
                                                          const LoadedCharacter& loaded,
                                                          const SaveOptions& options) {
  return gltf::influences_of_written(character, loaded, options);
}

Status save_glb(const std::filesystem::path& file, const Character& character,
                const SaveOptions& options) {
  return gltf::write_new_document(file, character, options);
}

Status save_with_materials(const std::filesystem::path& file, const Character& character,
                           const SourceDocument& materials, const SaveOptions& options) {
  return gltf::write_with_materials(file, character, materials, options);
}

std::vector<std::uint32_t> nodes_of_meshes(const SourceDocument& source) {
  std::vector<std::uint32_t> nodes;
  for (const SourceDocument::MeshOrigin& origin : source.mesh_origins) nodes.push_back(origin.node);
  return nodes;
}

}  // namespace sunder
