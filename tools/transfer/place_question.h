#pragma once

#include <sunder/core/character.h>

#include <string>

namespace sunder::tools {

/// What to ask where hardly any vertex of a target matches its source: whether both have one unit
/// and stand in one place, with their bounds in the bind pose.
[[nodiscard]] std::string question_of_place(const Character& source, const Character& target);

}  // namespace sunder::tools
