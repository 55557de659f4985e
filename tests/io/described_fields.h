#pragma once

#include <string>
#include <vector>

#include "core/operation/internal/describe_aimed.h"
#include "io/operation_log/write_fields.h"

namespace sunder::operation_log {

inline Json value_json(const AimedLength& length, const NumberRange&) {
  return length.unit == AimedLength::Unit::widths ? Json{{"widths", length.value}}
                                                  : Json(length.value);
}

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

/// The value in a log that does what leaving the field out does; null if none does.
template <class T>
Json default_json(const Field& field, const T& member, const auto&... kind) {
  if (field.use == Use::required || field.otherwise != nullptr) return {};
  if constexpr (kIsOptional<T>)
    return {};
  else if constexpr (Described<T>)
    return Json::object();
  else if constexpr (requires(T list) { list.emplace_back(); })
    return Json::array();
  else if constexpr (requires { value_json(member, kind...); })
    return value_json(member, kind...);
  else
    return {};
}

}  // namespace sunder::operation_log

namespace sunder::test {

/// A field as documentation has it.
struct DescribedField {
  Field field;
  operation_log::Json value_if_left_out;
};

/// Collects fields; those of an object within count as one.
struct FieldCollector {
  std::vector<DescribedField>& fields;

  void operator()(const Field& field, const auto& member, const auto&... kind) const {
    fields.push_back({field, operation_log::default_json(field, member, kind...)});
  }
  template <class PoseChanges>
  void operator()(const Field& field, const Stroke&, const Blades<PoseChanges>&) const {
    fields.push_back({field, {}});
  }
  void object(const Field& field, const auto&) const { fields.push_back({field, {}}); }
};

template <class T>
std::vector<DescribedField> described_fields() {
  std::vector<DescribedField> fields;
  const FieldCollector collector{fields};
  const T of{};
  describe(collector, of);
  return fields;
}

}  // namespace sunder::test
