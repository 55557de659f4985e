#pragma once

#include <assimp/scene.h>

#include "io/assimp/asset_io_system.h"
#include "io/assimp/notes.h"
#include "io/assimp/scene_tree.h"

namespace sunder::assimp_import {

/// The joints of the skins of a COLLADA file, as the file itself says. assimp 5.2 takes the first
/// node of the whole scene with the name, id or sid of a joint, whatever the skeleton, so a skin on
/// two skeletons is on the first one twice.
[[nodiscard]] JointNodes collada_joints(const aiScene& scene, const ModelFile& model, Notes& notes);

}  // namespace sunder::assimp_import
