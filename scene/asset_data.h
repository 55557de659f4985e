#pragma once

#include <sunder/scene/character_asset.h>
#include <sunder/tear/torn_asset.h>

#include <optional>
#include <vector>

#include "scene/drawing/asset_mesh.h"
#include "scene/torn_parts.h"

namespace sunder::scene {

/// The data of a CharacterAsset.
struct AssetData {
  std::shared_ptr<const Character> character;
  std::shared_ptr<const TornAsset> torn;
  std::shared_ptr<const ParticleAsset> particles;  ///< Null if it is not soft.
  std::optional<TissueAtRest> tissue;              ///< The same; of these particles.
  CharacterAssetOptions options;
  std::vector<AssetMesh> meshes;
};

}  // namespace sunder::scene
