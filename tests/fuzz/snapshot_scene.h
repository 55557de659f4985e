#pragma once

#include <sunder/scene/scene.h>

#include <memory>
#include <vector>

namespace sunder::fuzz {

using SnapshotAssets = std::vector<std::shared_ptr<const CharacterAsset>>;

/// Two soft sheets with a clip, whose numbers are the same on every machine, so that seeds name
/// them. The second has a morph target, and its new vertices are `exact`.
[[nodiscard]] SnapshotAssets make_snapshot_assets();
[[nodiscard]] Scene make_scene();
/// A scene of two instances of the first asset: one torn, cut and undone while it plays, with
/// tissue that moves; one that stands still.
[[nodiscard]] Scene make_torn_scene(const SnapshotAssets& assets);
/// A scene with an instance of each asset, and a free place. One has its work next to lips not
/// done, a hold, a collider and a force; the other plays layers with clips of their own, a mask and
/// a reference pose, a piece was taken off it, and weights were fitted in the background.
[[nodiscard]] Scene make_rich_scene(const SnapshotAssets& assets);

}  // namespace sunder::fuzz
