#include "io/gltf/meshopt_extension.h"

namespace sunder::gltf {

std::optional<Cursor> meshopt_extension_of(const Cursor& object) {
  if (const auto extensions = object.find("extensions"))
    for (const char* const name : kMeshoptNames)
      if (auto found = extensions->find(name)) return found;
  return {};
}

bool is_fallback_buffer(const Cursor& buffer) {
  const auto extension = meshopt_extension_of(buffer);
  return extension && extension->bool_or("fallback", false);
}

}  // namespace sunder::gltf
