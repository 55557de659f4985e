#pragma once

#include <set>

#include "io/gltf/glb.h"

namespace sunder::gltf {

/// Changes the materials of a draft so that renderers without surroundings and with few extensions
/// show them as intended: base colour, alpha and emission stay, metal and normal maps go, and unlit
/// materials with a texture emit their base colour. Textures whose image is not embedded as PNG or
/// JPEG are removed.
///
/// @param colored  materials of primitives with vertex colours, which emission would not show.
/// @return the number of materials that lost a texture.
std::uint32_t simplify_materials(Json& document, const std::set<std::uint32_t>& colored);

/// Embeds the images of data: URIs, which not every renderer reads.
void embed_data_uris(GlbDraft& draft);

}  // namespace sunder::gltf
