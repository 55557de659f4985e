#pragma once

#include "io/gltf/source_document.h"
#include "io/gltf_read/decoded_data.h"
#include "io/gltf_read/notes.h"

namespace sunder::gltf {

/// Decoders::draco_primitives, by Draco.
void decode_draco_primitives(SourceDocument& document, DecodedData& decoded, Notes& notes);

}  // namespace sunder::gltf
