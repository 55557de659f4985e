#pragma once

#include <sunder/operation/operation.h>

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/operation/internal/field.h"
#include "core/operation/internal/names.h"
#include "io/internal/strict_json.h"

namespace sunder::operation_log {

using Json = StrictJson;

// value_json(member, kind) is what a log has for a member of that kind. Doubles are written as the
// shortest text that is read back to the same bits; floats are written as doubles.

template <class T>
requires std::is_arithmetic_v<T> Json value_json(T value, const auto&...) { return value; }
inline Json value_json(const std::string& text, const auto&...) { return text; }
template <class Enum>
requires std::is_enum_v<Enum> Json value_json(Enum value) { return name_of(value); }
Json value_json(const Vec3f& vector);
Json value_json(const Quatf& rotation);
Json value_json(const Affine3d& matrix);
Json value_json(const PoseSpec& pose);
Json value_json(const PiecePlace& piece);
template <Described T>
Json value_json(const T& of);

Json numbers_json(const auto& numbers) {
  Json array = Json::array();
  for (const auto number : numbers) array.push_back(static_cast<double>(number));
  return array;
}
Json value_json(const Vec3d& vector, const auto&...) { return numbers_json(vector); }

template <class T>
Json value_json(const std::vector<T>& values, const List&) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(value_json(value));
  return array;
}
template <class T>
Json value_json(const std::optional<T>& value) {
  return value ? value_json(*value) : Json();
}
/// A name or an index.
template <class... Kinds>
Json value_json(const std::variant<Kinds...>& value, const Name&) {
  return std::visit([](const auto& of) { return Json(of); }, value);
}

inline bool is_set(bool value) { return value; }
inline bool is_set(double value) { return value > 0; }
inline bool is_set(std::uint32_t index) { return index != kNone; }
template <class T>
bool is_set(const std::optional<T>& value) {
  return value.has_value();
}
template <class List>
requires requires(const List& list) { list.empty(); }
bool is_set(const List& list) { return !list.empty(); }

/// Writes the described fields of a struct.
class FieldWriter {
 public:
  explicit FieldWriter(Json& json) : json_(json) {}

  void operator()(const Field& field, const auto& member, const auto&... kind) const {
    if (field.refusal != nullptr) return;
    if constexpr (requires { is_set(member); })
      if (field.use == Use::if_set && !is_set(member)) return;
    json_[field.name] = value_json(member, kind...);
  }
  /// The blades of a tear follow on lines of their own.
  template <class PoseChanges>
  void operator()(const Field&, const Stroke&, const Blades<PoseChanges>&) const {}
  void object(const Field& field, const auto& body) const {
    const FieldWriter inside(json_[field.name] = Json::object());
    body(inside);
  }

 private:
  Json& json_;
};

template <Described T>
Json value_json(const T& of) {
  Json json = Json::object();
  const FieldWriter writer(json);
  describe(writer, of);
  return json;
}

}  // namespace sunder::operation_log
