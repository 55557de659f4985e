#pragma once

#include "io/gltf/glb.h"

namespace sunder::gltf {

/// Makes images and the textures that show them follow the rules of glTF: media types are those of
/// the data, WebP is declared, and embedded data that no program can decode becomes a white pixel.
/// References to other files stay.
/// @param draft  its document follows enforce_schema().
void repair_images(GlbDraft& draft);

}  // namespace sunder::gltf
