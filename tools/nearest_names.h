#pragma once

#include <span>
#include <string>
#include <vector>

namespace sunder::tools {

/// Names that a mistyped one may stand for, nearest first: at most three, by the number of letters
/// to insert, delete, replace or swap, capitals aside, or because one contains the other.
[[nodiscard]] std::vector<std::string> nearest_names(const std::string& wanted,
                                                     std::span<const std::string> names);

/// "; did you mean 'Walk' or 'WalkBack'?", or a list of what there is if nothing is near.
/// @param kind  "clips".
[[nodiscard]] std::string name_advice(const std::string& wanted, const char* kind,
                                      std::span<const std::string> names);

}  // namespace sunder::tools
