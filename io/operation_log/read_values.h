#pragma once

#include <sunder/operation/aimed_operation.h>

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/operation/internal/field.h"
#include "core/operation/internal/names.h"
#include "io/operation_log/place.h"

namespace sunder::operation_log {

// read_value(place, field, member, kind) reads a field of a description, or throws a Fault.

void read_value(const Place& place, const Field& field, double& number, const NumberRange& range);
void read_value(const Place& place, const Field& field, double& radians, const Degrees& kind);
void read_value(const Place& place, const Field& field, double& tolerance,
                const ChordTolerance& kind);
/// Metres or, in a slash, widths of the limb.
void read_value(const Place& place, const Field& field, double& length,
                const TearLength<std::optional<double>>& kind);
void read_value(const Place& place, const Field& field, double& length,
                const TearLength<const std::optional<double>>& kind);
void read_value(const Place& place, const Field& field, AimedLength& length,
                const NumberRange& range);
void read_value(const Place& place, const Field& field, bool& value);
void read_value(const Place& place, const Field& field, std::uint32_t& number, const Integer& kind);
/// The index of a material of the file, or its name if the model has one material of that name.
void read_value(const Place& place, const Field& field, std::uint32_t& index, const Material& kind);
void read_value(const Place& place, const Field& field, std::string& name, const Name& kind);
void read_value(const Place& place, const Field& field, Vec3d& point, const Point& kind);
void read_value(const Place& place, const Field& field, Vec3d& direction, const Direction& kind);
void read_value(const Place& place, const Field& field, Vec3f& vector);
/// Normalises the rotation. Rotations of unit length keep their bits, so that logs are read back
/// exactly.
void read_value(const Place& place, const Field& field, Quatf& rotation);
void read_value(const Place& place, const Field& field, std::array<double, 3>& barycentrics);
void read_value(const Place& place, const Field& field, View& view);
void read_value(const Place& place, const Field& field, std::vector<Affine3d>& matrices,
                const List& kind);
void read_value(const Place& place, const Field& field, std::vector<float>& numbers,
                const List& kind);

/// The enumerator of a word. @return its index.
std::size_t read_word(const Place& place, const Field& field, std::span<const char* const> words);

template <class Enum>
requires std::is_enum_v<Enum>
void read_value(const Place& place, const Field& field, Enum& value) {
  value = static_cast<Enum>(read_word(place, field, kNames<Enum>));
}

/// A name or an index.
template <class... Kinds>
void read_value(const Place& place, const Field& field, std::variant<Kinds...>& value,
                const Name&) {
  if (place.value.is_string())
    value = read_name(place);
  else
    value = read_integer(place, (std::string("the ") + field.name + "'s name or index").c_str());
}

}  // namespace sunder::operation_log
