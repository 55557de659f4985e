#pragma once

#include "io/gltf/source_document.h"
#include "io/gltf_read/decoded_data.h"
#include "io/gltf_read/notes.h"

namespace sunder::gltf {

/// Decodes the primitives that KHR_draco_mesh_compression compresses: the document becomes one
/// without that extension, whose accessors have the decoded data. Saving writes these. Primitives
/// that have their data uncompressed too only lose the extension. The document's buffer views must
/// have been checked.
void decode_draco_primitives(SourceDocument& document, DecodedData& decoded, Notes& notes);

}  // namespace sunder::gltf
