#pragma once

#include <cstdint>
#include <vector>

#include "io/gltf/source_document.h"
#include "io/gltf_read/decoded_data.h"
#include "io/gltf_read/notes.h"

namespace sunder::gltf {

/// Decoders::meshopt_views, by meshoptimizer.
std::vector<std::uint32_t> decode_meshopt_views(SourceDocument& document, DecodedData& decoded,
                                                Notes& notes);

}  // namespace sunder::gltf
