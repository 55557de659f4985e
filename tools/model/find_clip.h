#pragma once

#include <sunder/core/character.h>

#include <optional>
#include <string_view>

namespace sunder::tools {

/// The clip with a name or, if there is none, the only one with that name behind a namespace:
/// "Walk" for "Armature|Walk".
[[nodiscard]] std::optional<std::uint32_t> find_clip(const Character& character,
                                                     std::string_view name);

}  // namespace sunder::tools
