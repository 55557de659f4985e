#pragma once

#include <sunder/core/api.h>

#include <span>
#include <string>
#include <string_view>

namespace sunder {

/// The names most like one that was not found, for an error text: "'LeftArm' or 'LeftHand'", at
/// most three. Compares by edit distance without regard to case; a namespace before ':' or '|' does
/// not count. Empty if none is similar. O(names x lengths), allocates.
[[nodiscard]] SUNDER_API std::string nearest_names(std::string_view wanted,
                                                   std::span<const std::string_view> names);

/// A name without its namespace: what follows the last ':' or '|'.
[[nodiscard]] SUNDER_API std::string_view without_namespace(std::string_view name);

}  // namespace sunder
