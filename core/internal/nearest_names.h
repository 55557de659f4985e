#pragma once

#include <sunder/core/api.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sunder {

/// Names that a mistyped one may stand for, nearest first: at most three, by the number of letters
/// to insert, delete, replace or swap, capitals and namespaces aside, or because one contains the
/// other or is near to a word of it ("Nek" to "spine_neck_1").
/// Compares only the first 128 letters of names. O(lengths of the names), allocates.
[[nodiscard]] SUNDER_API std::vector<std::string> nearest_names(const std::string& wanted,
                                                                std::span<const std::string> names);

/// The words of a name in small letters: of "LeftUpLeg" and "left_up_leg.001" left, up and leg.
[[nodiscard]] SUNDER_API std::vector<std::string> words_of(std::string_view name);

/// "'Walk', 'Run' or 'Jump'".
[[nodiscard]] SUNDER_API std::string listed_names(std::span<const std::string> names);

/// A name without its namespace: what follows the last ':' or '|'.
[[nodiscard]] SUNDER_API std::string_view without_namespace(std::string_view name);

}  // namespace sunder
