#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/internal/nearest_names.h"

namespace sunder::tools {

using sunder::nearest_names;

/// "; did you mean 'Walk' or 'WalkBack'?", or a list of what there is if nothing is near.
/// @param kind  "clips".
[[nodiscard]] std::string name_advice(const std::string& wanted, const char* kind,
                                      std::span<const std::string> names);

}  // namespace sunder::tools
