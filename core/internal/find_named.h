#pragma once

#include <sunder/core/api.h>
#include <sunder/core/character.h>

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace sunder {

/// The clip with a name or, if there is none, the only one with that name behind a namespace:
/// "Walk" for "Armature|Walk".
[[nodiscard]] SUNDER_API std::optional<Index> find_clip(const Character& character,
                                                        std::string_view name);
/// The same by name or by index, as poses name clips.
[[nodiscard]] SUNDER_API std::optional<Index> find_named_clip(
    const Character& character, const std::variant<std::string, Index>& clip);

/// The index of the material with a name, as `sunder info` lists them: those of the submeshes.
/// @return not_found with the nearest names; invalid_argument if several have it.
[[nodiscard]] SUNDER_API Result<Index> find_material(const Character& character,
                                                     std::string_view name);

}  // namespace sunder
