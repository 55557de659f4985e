#pragma once

#include <sunder/core/character.h>

#include <cstdint>

namespace sunder::scene {

/// A hash of all that tears and motion depend on: meshes, skins, bones, clips. Equal characters
/// have equal digests on every machine. O(size of the character).
[[nodiscard]] std::uint64_t digest_of(const Character& character);

}  // namespace sunder::scene
