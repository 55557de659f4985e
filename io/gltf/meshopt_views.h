#pragma once

#include <cstdint>
#include <vector>

#include "io/gltf/decoded_data.h"
#include "io/gltf/notes.h"
#include "io/gltf/source_document.h"

namespace sunder::gltf {

/// Whether a buffer of /buffers is only a place holder for the decoded data of compressed buffer
/// views. It has no bytes.
[[nodiscard]] bool is_fallback_buffer(const Cursor& buffer);

/// Decodes the buffer views that EXT_meshopt_compression or KHR_meshopt_compression compress: the
/// document becomes one without that extension, whose views have the decoded bytes. Saving writes
/// these. Compressed data counts where a file has both.
/// @return the views whose data a filter rounded.
std::vector<std::uint32_t> decode_meshopt_views(SourceDocument& document, DecodedData& decoded,
                                                Notes& notes);

}  // namespace sunder::gltf
