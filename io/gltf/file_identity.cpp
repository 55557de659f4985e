#include "io/gltf/file_identity.h"

#include "core/internal/sha256.h"
#include "io/gltf/source_document.h"

namespace sunder::gltf {

FileIdentity identity_of(std::span<const std::byte> content) {
  Sha256 digest;
  digest.add(content);
  return {content.size(), digest.finish()};
}

FileIdentity identity_of(const SourceDocument& document) {
  return document.is_glb ? identity_of(std::span(document.content)) : document.text_identity;
}

}  // namespace sunder::gltf
