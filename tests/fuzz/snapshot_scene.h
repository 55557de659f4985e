#pragma once

#include <sunder/scene/scene.h>

#include <memory>
#include <vector>

namespace sunder::fuzz {

/// A soft sheet with a clip, whose numbers are the same on every machine, so that seeds name it.
[[nodiscard]] std::shared_ptr<const CharacterAsset> make_snapshot_asset();
[[nodiscard]] Scene make_scene();
/// A scene of two instances: one torn, cut and undone while it plays, with tissue that moves; one
/// that stands still.
[[nodiscard]] Scene make_torn_scene(const std::shared_ptr<const CharacterAsset>& asset);

}  // namespace sunder::fuzz
