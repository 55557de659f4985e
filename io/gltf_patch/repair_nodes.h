#pragma once

#include "io/gltf/cursor.h"

namespace sunder::gltf {

/// Makes nodes, skins and scenes follow the rules of glTF without moving anything: rotations get
/// unit length, matrices that are no product of translation, rotation and scale become two nodes,
/// skins get a common root in their scene, and joints are different nodes. What refers to nothing
/// is removed.
/// @param document  follows enforce_schema(); its nodes are a forest, and no primitive is null.
void repair_nodes(Json& document);

}  // namespace sunder::gltf
