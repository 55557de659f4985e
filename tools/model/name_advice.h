#pragma once

#include <span>
#include <string>

namespace sunder::tools {

/// Follows an error about a name that is not there: "; did you mean 'Walk' or 'WalkBack'?", or a
/// list of what there is if nothing is near.
/// @param kind  "clips" or "bones".
[[nodiscard]] std::string name_advice(const std::string& wanted, const char* kind,
                                      std::span<const std::string> names);

}  // namespace sunder::tools
