#pragma once

#include <optional>
#include <string_view>

namespace sunder::tools {

/// The quantity of a number on the command line.
enum class Quantity {
  number,  ///< Without a unit.
  length,  ///< Metres: m, cm, mm, um.
  share,   ///< Parts of one: %.
  time,    ///< Seconds: s, ms, min.
  angle,   ///< Degrees: deg.
};

/// A finite number with or without a unit, "2 cm" or "0.02", in the first unit of its quantity.
/// @return nothing for other texts.
[[nodiscard]] std::optional<double> quantity_in(std::string_view text, Quantity quantity);

/// A length in metres whose unit must be given, as "0.1mm": where half a millimetre and half a
/// metre are both usual, a number alone could be either.
/// @return nothing for other texts, and for a negative number.
[[nodiscard]] std::optional<double> length_with_unit(std::string_view text);

/// The units of a quantity, for errors: ", or with a unit: m, cm, mm, um"; empty for numbers.
[[nodiscard]] const char* units_of(Quantity quantity);

}  // namespace sunder::tools
