#pragma once

#include <sunder/scene/character_asset.h>

#include <cstdint>

namespace sunder::scene {

/// A hash of all that tears and motion depend on: meshes, skins, bones, clips, how the surface is
/// divided into particles, and coarser levels of detail. Equal assets have equal digests on every
/// machine. O(size of the characters).
[[nodiscard]] std::uint64_t digest_of(const CharacterAsset& asset);

}  // namespace sunder::scene
