#pragma once

#include <cstdint>
#include <vector>

#include "io/gltf/source_document.h"
#include "io/gltf_read/decoded_data.h"
#include "io/gltf_read/notes.h"

namespace sunder::gltf {

/// Decodes the buffer views that EXT_meshopt_compression or KHR_meshopt_compression compress: the
/// document becomes one without that extension, whose views have the decoded bytes. Saving writes
/// these. Compressed data counts where a file has both.
/// @return the views whose data a filter rounded.
std::vector<std::uint32_t> decode_meshopt_views(SourceDocument& document, DecodedData& decoded,
                                                Notes& notes);

}  // namespace sunder::gltf
