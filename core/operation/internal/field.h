#pragma once

#include <sunder/core/index.h>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/internal/number_range.h"

namespace sunder {

// Each operation and each struct in one has one description: describe(walker, value) calls
// walker(field, member, kind) for each of its fields. Logs are read and written by it, ranges are
// checked, and the JSON schema, the options of the command and the tables of docs are made from it
// or compared with it. A new field has one entry here, behind the member in the public header.

/// When a field is in a log.
enum class Use : std::uint8_t {
  required,  ///< Without it, a log is refused.
  written,   ///< May be left out; is always written.
  if_set,    ///< May be left out; is written if it differs from a new struct's.
};

struct Field {
  const char* name;  ///< In logs.
  const char* text;  ///< One line of documentation.
  Use use = Use::written;
  /// What a log without the field means, where that is not the value in a new struct.
  const char* otherwise = nullptr;
  /// Why a field that is given here is refused; such a field is not written. Null: it is taken.
  const char* refusal = nullptr;
};

// Kinds: what a member's type does not tell. A number of a log has a NumberRange, whose name is
// that of the field.

/// An angle: degrees in a log, radians in a struct.
struct Degrees {
  NumberRange range;
};
/// The chord tolerance of a bore of that radius.
struct ChordTolerance {
  double radius;
};
/// A length of a tear. A slash may have it in widths of the limb.
template <class Widths>  // std::optional<double>
struct TearLength {
  NumberRange range;
  Widths* in_widths = nullptr;  ///< Null: in metres only.
  bool is_depth = false;        ///< As large as the limb is thick, not only wide.
};
template <class Widths>
TearLength(NumberRange, Widths*) -> TearLength<Widths>;
template <class Widths>
TearLength(NumberRange, Widths*, bool) -> TearLength<Widths>;
/// The blades of a tear, some of which have a pose.
template <class PoseChanges>
struct Blades {
  PoseChanges* pose_changes;
};
template <class PoseChanges>
Blades(PoseChanges*) -> Blades<PoseChanges>;
/// An index or a count.
struct Integer {
  const char* what;  ///< For errors: "an operation's index".
  std::uint32_t least = 0, most = kNone - 1;
};
/// The index of a material; kNone: none is given.
struct Material {};
/// A place in model space.
struct Point {};
/// A vector of any length except zero.
struct Direction {
  const char* what;  ///< For errors: "normal".
};
struct Name {
  bool may_be_empty = false;
};
/// A list of values.
struct List {
  const char* of = nullptr;  ///< For errors: "points". Null: "an array".
  std::size_t least = 0;
  const char* too_few = nullptr;  ///< The error of a shorter list.
};

/// `T` is the struct or the constant struct; for the declarations of describe().
template <class T, class Struct>
concept Is = std::same_as<std::remove_const_t<T>, Struct>;

/// A walker that collects the names of fields.
struct FieldNames {
  std::vector<std::string_view> names;

  void operator()(const Field& field, const auto&...) { names.emplace_back(field.name); }
  void object(const Field& field, const auto&) { names.emplace_back(field.name); }
};

/// A struct that has a description.
template <class T>
concept Described = std::is_aggregate_v<T> && requires(FieldNames& names, T& of) {
  describe(names, of);
};

}  // namespace sunder
