#pragma once

#include <sunder/core/character.h>

#include <cstdint>
#include <optional>
#include <span>

#include "tools/open/opening.h"

namespace sunder::tools {

/// The name of the appended morph target.
inline constexpr const char* kOpenTarget = "Open";

/// When a clip shows a tear.
struct ClipMoment {
  std::uint32_t clip = 0;
  double seconds = 0;
  std::optional<double> end = {};  ///< Of the opening; empty: as the tissue takes.
};

/// A torn character with an opening as one more morph target of the meshes that gape. Its weight
/// rests at 1; in clips that show the tear it is 0 until the first moment, then follows the
/// opening. Weights of a mesh that gets a target move to the end of Character::rest_morph_weights.
///
/// @param torn   the character for which the opening was measured, perhaps with other weights.
/// @param nodes  per mesh: meshes of one node get the same targets, because they share weights.
/// @return the failures of displacement_in_bind().
[[nodiscard]] Result<Character> with_open_target(Character torn, const Opening& opening,
                                                 std::span<const std::uint32_t> nodes,
                                                 std::span<const ClipMoment> moments);

/// A torn character whose own positions, normals and tangents gape.
[[nodiscard]] Result<Character> with_open_positions(Character torn, const Opening& opening);

}  // namespace sunder::tools
