#pragma once

#include "io/gltf/cursor.h"

namespace sunder::gltf {

/// Removes null primitives, and makes the primitives of a mesh agree: with each other in their
/// morph targets, and with their materials in their texture coordinates. A node whose mesh has no
/// primitive left loses it.
/// @param document  follows enforce_schema(), but for null primitives.
void repair_meshes(Json& document);

}  // namespace sunder::gltf
