#pragma once

#include <sunder/core/api.h>
#include <sunder/core/character.h>

namespace sunder {

/// Checks a clip that is not one of the character's own by the rules of validate_character().
/// O(keys), no allocation. @return the first fault, with the channel.
[[nodiscard]] SUNDER_API Status validate_clip(const Character& character, const Clip& clip);

}  // namespace sunder
