#include "core/internal/number_range.h"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace sunder {
namespace {

/// Fixed size, so that a refusal does not allocate.
struct RangeText {
  char text[96];
};

RangeText text_of(const NumberRange& range) {
  RangeText of{};
  const bool has_else = range.or_else != nullptr;
  std::snprintf(of.text, sizeof of.text,
                range.is_above_least ? "above %g and at most %g%s%s%s" : "from %g to %g%s%s%s",
                range.least, range.most, range.unit, has_else ? ", or " : "",
                has_else ? range.or_else : "");
  return of;
}

}  // namespace

std::string NumberRange::text() const { return text_of(*this).text; }

Status NumberRange::check(double value) const {
  if (holds(value)) return {};
  return Status::failure(
      std::isfinite(value) ? StatusCode::invalid_argument : StatusCode::non_finite_value, kNone,
      "%s is %g%s; it must be %s", field, value, unit, text_of(*this).text);
}

Status NumberRange::check_degrees(double radians) const {
  // 80 degrees stay 80 on the way through radians, also as float.
  constexpr double kSteps = 1e5;
  return check(std::round(radians * 180 / std::numbers::pi * kSteps) / kSteps);
}

}  // namespace sunder
