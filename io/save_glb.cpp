#include <sunder/io/character_file.h>

#include "io/gltf/new_document.h"
#include "io/gltf/write.h"

namespace sunder {

Status save_glb(const std::filesystem::path& file, const Character& character,
                const LoadedCharacter& loaded, const SaveOptions& options) {
  return gltf::write_character(file, character, loaded, options);
}

Status save_glb(const std::filesystem::path& file, const Character& character,
                const SaveOptions& options) {
  return gltf::write_new_document(file, character, options);
}

}  // namespace sunder
