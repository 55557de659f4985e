#pragma once

#include <sunder/scene/character_asset.h>
#include <sunder/tear/torn_asset.h>

#include <vector>

#include "scene/drawing/asset_mesh.h"

namespace sunder::scene {

/// The data of a CharacterAsset.
struct AssetData {
  std::shared_ptr<const Character> character;
  std::shared_ptr<const TornAsset> torn;
  std::shared_ptr<const ParticleAsset> particles;  ///< Null if it is not soft.
  CharacterAssetOptions options;
  std::vector<AssetMesh> meshes;
};

}  // namespace sunder::scene
