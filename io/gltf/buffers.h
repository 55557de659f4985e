#pragma once

#include "io/gltf/container.h"
#include "io/gltf/source_document.h"

namespace sunder::gltf {

/// Fills document.buffers from the BIN chunk, data: URIs, and files of document.folder. Then checks
/// that every entry of /bufferViews lies in its buffer.
void resolve_buffers(SourceDocument& document, const Container& container);

/// The bytes of a buffer view that resolve_buffers() has checked.
[[nodiscard]] std::span<const std::byte> bytes_of_view(const SourceDocument& document,
                                                       std::uint32_t view);

}  // namespace sunder::gltf
