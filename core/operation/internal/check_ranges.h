#pragma once

#include <sunder/operation/aimed_operation.h>

#include <type_traits>

#include "core/operation/internal/field.h"
#include "core/operation/internal/field_ranges.h"
#include "core/operation/internal/names.h"

namespace sunder {

/// Checks numbers and enumerators of a described struct. Later ones are not checked after a fault.
class RangeCheck {
 public:
  void operator()(const Field& field, double value, const NumberRange& range) {
    if (status_) status_ = field::named(range, field.name).check(value);
  }
  void operator()(const Field& field, double radians, const Degrees& kind) {
    if (status_) status_ = field::named(kind.range, field.name).check_degrees(radians);
  }
  void operator()(const Field&, double tolerance, const ChordTolerance& kind) {
    if (status_) status_ = field::check_chord_tolerance(tolerance, kind.radius);
  }
  template <class Widths>
  void operator()(const Field& field, double length, const TearLength<Widths>& kind) {
    if (kind.in_widths != nullptr && *kind.in_widths)
      (*this)(field, **kind.in_widths, field::kWidthsFromZero);
    else
      (*this)(field, length, kind.range);
  }
  void operator()(const Field& field, const AimedLength& length, const NumberRange& range) {
    (*this)(field, length.value, length.unit == AimedLength::Unit::metres ? range : field::kWidths);
  }
  void operator()(const Field& field, const std::optional<AimedLength>& length,
                  const NumberRange& range) {
    if (length) (*this)(field, *length, range);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(const Field& field, Enum value) {
    if (status_ && value > last_named<Enum>())
      status_ = Status::failure(StatusCode::invalid_argument, kNone, "unknown %s %u", field.name,
                                static_cast<unsigned>(value));
  }
  void operator()(const Field&, const auto&...) {}
  void object(const Field&, const auto&) {}

  [[nodiscard]] const Status& status() const { return status_; }

 private:
  Status status_;
};

/// @return the first fault, as NumberRange::check().
template <class T>
Status check_ranges(const T& of) {
  RangeCheck check;
  describe(check, of);
  return check.status();
}

}  // namespace sunder
