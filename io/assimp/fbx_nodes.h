#pragma once

#include <assimp/scene.h>

#include "io/assimp/asset_io_system.h"
#include "io/assimp/notes.h"

namespace sunder::assimp_import {

/// Replaces the nodes' transforms and the animations that assimp made of an FBX file by those that
/// io/fbx reads from the file itself. assimp 5.2 applies pre- and post-rotations twice where a
/// model has no pivots, ignores how scales are inherited, layers and curves that are no lines, and
/// takes components without a curve as zero. Meshes, skins, materials and morph channels stay as
/// assimp read them.
///
/// @param scene  that of the importer, with pivots preserved as nodes.
/// @throws ImportFailure (internal_error) if assimp's nodes are not those of the file;
///         std::runtime_error if the file is malformed.
void take_fbx_transforms(aiScene& scene, const ModelFile& model, Notes& notes);

}  // namespace sunder::assimp_import
