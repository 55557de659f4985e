#pragma once

#include <optional>
#include <string_view>

namespace sunder::tools {

/// A length in metres: a number, without a unit or followed by m, cm, mm or um, as "0.1mm".
/// @return nothing for other text, and for a number that is negative or not finite.
[[nodiscard]] std::optional<double> parse_length(std::string_view text);

}  // namespace sunder::tools
