#pragma once

#include "io/gltf/container.h"
#include "io/gltf/source_document.h"

namespace sunder::gltf {

/// Fills document.buffers from the BIN chunk, data: URIs, and document.side_files.
void resolve_buffers(SourceDocument& document, const Container& container);

/// Checks that every entry of /bufferViews lies in its buffer.
void check_buffer_views(const SourceDocument& document);

/// The bytes of a buffer view that check_buffer_views() has checked.
[[nodiscard]] std::span<const std::byte> bytes_of_view(const SourceDocument& document,
                                                       std::uint32_t view);

}  // namespace sunder::gltf
