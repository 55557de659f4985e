#pragma once

#include <sunder/scene/character_asset.h>
#include <sunder/skinning/skinned_mesh.h>

#include <vector>

#include "scene/draw_order.h"

namespace sunder::scene {

/// One mesh of an asset.
struct AssetMesh {
  SkinnedMesh skinned;
  std::size_t slots = 0;  ///< Of its skin.
  DrawOrder order;
  bool poses_vertices = true, has_normals = false, has_tangents = false;
};

/// The data of a CharacterAsset.
struct AssetData {
  std::shared_ptr<const Character> character;
  CharacterAssetOptions options;
  std::vector<AssetMesh> meshes;
};

}  // namespace sunder::scene
