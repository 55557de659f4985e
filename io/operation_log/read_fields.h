#pragma once

#include <utility>

#include "io/operation_log/read_values.h"

namespace sunder::operation_log {

PoseSpec read_pose(const Place& place);

/// The names of the fields of a struct.
template <class T>
const std::vector<std::string_view>& names_of() {
  static const std::vector<std::string_view> names = [] {
    FieldNames fields;
    const T of{};
    describe(fields, of);
    return fields.names;
  }();
  return names;
}

/// Reads the described fields of an object. Throws a Fault.
class FieldReader {
 public:
  explicit FieldReader(const Place& place) : place_(place) {}

  template <class T, class... Kind>
  void operator()(const Field& field, T& member, const Kind&... kind) const {
    if (const std::optional<Place> found = find(field)) read_value(*found, field, member, kind...);
  }
  /// Reads a field that is an object of further fields.
  template <class Body>
  void object(const Field& field, const Body& body) const {
    const std::optional<Place> found = find(field);
    if (!found) return;
    FieldNames fields;
    body(fields);
    found->check_fields(fields.names);
    const FieldReader inside(*found);
    body(inside);
  }

 private:
  [[nodiscard]] std::optional<Place> find(const Field& field) const {
    if (field.use != Use::required && !place_.has(field.name)) return {};
    Place found = place_.at(field.name);
    if (field.refusal != nullptr) found.malformed(field.refusal);
    return found;
  }

  const Place& place_;
};

// Rules over several fields of a struct that was read.
inline void check_read(const Place&, const auto&) {}
void check_read(const Place& place, const Blade& blade);
void check_read(const Place& place, const WeightOptions& options);
void check_read(const Place& place, const JointLimit& limit);
void check_read(const Place& place, const SeverOperation& sever);

/// @param more  names of fields that are read elsewhere.
template <class T>
void read_fields(const Place& place, T& of, std::initializer_list<std::string_view> more = {}) {
  place.check_fields(names_of<T>(), more);
  const FieldReader reader(place);
  describe(reader, of);
  check_read(place, of);
}

template <Described T>
void read_value(const Place& place, const Field&, T& of) {
  read_fields(place, of);
}

inline void read_value(const Place& place, const Field&, PoseSpec& pose) {
  pose = read_pose(place);
}

template <class T, class... Kind>
void read_value(const Place& place, const Field& field, std::optional<T>& value,
                const Kind&... kind) {
  T read{};
  read_value(place, field, read, kind...);
  value = std::move(read);
}

template <class T>
void read_value(const Place& place, const Field& field, std::vector<T>& values, const List& list) {
  const std::string array = list.of == nullptr ? "an array" : std::string("an array of ") + list.of;
  const std::size_t count = read_array(place, array.c_str()).size();
  if (count < list.least) place.malformed(list.too_few);
  values.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    if constexpr (std::is_same_v<T, Vec3d>)
      read_value(place.at(i), field, values.emplace_back(), Point{});
    else
      read_value(place.at(i), field, values.emplace_back());
}

void read_value(const Place& place, const Field& field, Stroke& stroke,
                const Blades<std::vector<TearOperation::PoseChange>>& kind);
void read_value(const Place& place, const Field& field, PiecePlace& piece);

}  // namespace sunder::operation_log
