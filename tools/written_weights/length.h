#pragma once

#include <optional>
#include <string_view>

namespace sunder::tools {

/// A length in metres: a number and m, cm, mm or um, as "0.1mm". A number alone is no length,
/// because half a millimetre and half a metre would be written alike.
/// @return nothing for other text, and for a number that is negative or not finite.
[[nodiscard]] std::optional<double> parse_length(std::string_view text);

}  // namespace sunder::tools
