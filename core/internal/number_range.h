#pragma once

#include <sunder/core/api.h>
#include <sunder/core/status.h>

#include <string>

namespace sunder {

/// The values that a number may have which a user gives: a field of a log, an option of the command
/// or of a C++ struct. Whoever reads the number checks it by the same range, and all errors have
/// one text: "lip_roll is -1 m; it must be from 0 to 1e+30 m".
struct NumberRange {
  const char* field;
  double least = 0, most = 0;
  const char* unit = "";          ///< Behind numbers, " m".
  bool is_above_least = false;    ///< `least` itself is not allowed.
  const char* or_else = nullptr;  ///< A value outside that is checked elsewhere: "0".

  /// False for NaN.
  [[nodiscard]] constexpr bool holds(double value) const {
    return (is_above_least ? value > least : value >= least) && value <= most;
  }
  /// "from 0 to 1e+30 m".
  [[nodiscard]] SUNDER_API std::string text() const;
  /// @return non_finite_value or invalid_argument, with the field, the value and the range.
  [[nodiscard]] SUNDER_API Status check(double value) const;
  /// Checks an angle in radians by a range in degrees.
  [[nodiscard]] SUNDER_API Status check_degrees(double radians) const;
};

}  // namespace sunder
