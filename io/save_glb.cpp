#include <sunder/io/character_file.h>

#include "io/gltf/refusal.h"
#include "io/gltf_write/new_document.h"
#include "io/internal/copied_materials.h"
#include "io/internal/staged_file.h"

namespace sunder {
namespace {

Status write_bytes(const std::filesystem::path& file, const Result<std::vector<std::byte>>& bytes) {
  return bytes ? write_file(file, *bytes) : bytes.error();
}

}  // namespace

Status save_glb(const std::filesystem::path& file, const Character& character,
                const LoadedCharacter& loaded, const SaveOptions& options) {
  return write_bytes(file, save_glb(character, loaded, options));
}

Status save_glb(const std::filesystem::path& file, const Character& character,
                const SaveOptions& options) {
  return write_bytes(file, save_glb(character, options));
}

Status save_with_materials(const std::filesystem::path& file, const Character& character,
                           const SourceDocument& materials, const SaveOptions& options) {
  return write_bytes(file, gltf::without_exceptions<std::vector<std::byte>>(
                               [&] { return gltf::new_document(character, options, &materials); }));
}

}  // namespace sunder
