#include <sunder/io/character_bytes.h>

#include "io/gltf/refusal.h"
#include "io/gltf/source_document.h"
#include "io/gltf_patch/write.h"
#include "io/gltf_write/new_document.h"
#include "io/internal/mesh_nodes.h"

namespace sunder {

Result<std::vector<std::byte>> save_glb(const Character& character, const LoadedCharacter& loaded,
                                        const SaveOptions& options) {
  return gltf::without_exceptions<std::vector<std::byte>>(
      [&] { return gltf::glb_of(character, loaded, options); });
}

Result<std::vector<std::byte>> save_glb(const Character& character, const SaveOptions& options) {
  return gltf::without_exceptions<std::vector<std::byte>>(
      [&] { return gltf::new_document(character, options, nullptr); });
}

Result<std::vector<WrittenInfluences>> written_influences(const Character& character,
                                                          const LoadedCharacter& loaded,
                                                          const SaveOptions& options) {
  return gltf::influences_of_written(character, loaded, options);
}

std::vector<std::uint32_t> nodes_of_meshes(const SourceDocument& source) {
  std::vector<std::uint32_t> nodes;
  for (const SourceDocument::MeshOrigin& origin : source.mesh_origins) nodes.push_back(origin.node);
  return nodes;
}

}  // namespace sunder
