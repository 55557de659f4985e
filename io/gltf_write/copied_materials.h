#pragma once

#include "io/gltf/glb.h"

namespace sunder::gltf {

/// Copies the materials of a source document into an empty draft, with the textures, samplers and
/// images that they need and the extensions that these name. Images of the source's folder are
/// embedded; references to images that cannot be read stay.
/// Their indices are those of the source.
void copy_materials(const SourceDocument& source, GlbDraft& draft);

}  // namespace sunder::gltf
