#pragma once

#include <sunder/scene/character_asset.h>

#include <memory>

#include "bindings/c/character.h"

namespace sunder::c {

/// An asset with the character that it was made from. Immutable.
struct AssetParts {
  std::shared_ptr<const CharacterAsset> asset;
  std::shared_ptr<const CharacterParts> character;
};

struct AssetObject : Object {
  static constexpr Kind kKind = Kind::asset;
  std::shared_ptr<const AssetParts> parts;
};

/// sunder_material and SoftMaterial, without the name.
[[nodiscard]] SoftMaterial material_of(const sunder_material& material);

/// Reads a policy and a number of influences.
/// @return empty for SUNDER_WEIGHTS_OF_MODEL; invalid_argument for no policy, named by `field`.
[[nodiscard]] Result<std::optional<WeightOptions>> weights_of(std::int32_t policy,
                                                              std::uint32_t maximum_influences);

}  // namespace sunder::c
