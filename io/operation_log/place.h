#pragma once

#include <sunder/core/character.h>
#include <sunder/core/math.h>
#include <sunder/core/status.h>

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "core/internal/number_range.h"
#include "io/internal/strict_json.h"

namespace sunder::operation_log {

using Json = StrictJson;

constexpr double kLargest = 1e9;  ///< Largest absolute value of metres, seconds and scales.
constexpr double kLargestMatrixEntry =
    1e30;  ///< Largest absolute entry of a bone matrix; matrices may have any scale.

/// Carries a fault out of nested readers; never leaves io/operation_log.
struct Fault {
  Status status;
};

/// A value and the JSON pointer to it.
struct Place {
  const Json& value;
  std::string path;
  std::uint32_t operation = kNone;
  const Character* model = nullptr;  ///< Whose materials may be named; null: none.

  [[noreturn]] void fail(StatusCode code, const std::string& text) const;
  [[noreturn]] void malformed(const std::string& text) const {
    fail(StatusCode::malformed_file, text);
  }
  [[noreturn]] void expected(const char* what) const;

  [[nodiscard]] Place at(std::size_t index) const;
  [[nodiscard]] Place at(const std::string& key) const;
  /// Calls visit(name, place) for each field of an object. at() would search the object for each.
  template <class Visit>
  void for_each_field(const Visit& visit) const {
    for (const auto& [name, field] : value.items())
      visit(name, Place{field, pointer_to(name), operation, model});
  }
  /// The JSON pointer to a field.
  [[nodiscard]] std::string pointer_to(const std::string& key) const;
  [[nodiscard]] bool has(const char* key) const { return value.contains(key); }

  /// @param more  further names.
  void check_fields(std::span<const std::string_view> known,
                    std::initializer_list<std::string_view> more = {}) const;
  void check_fields(std::initializer_list<std::string_view> known) const {
    check_fields({}, known);
  }
};

// Each function checks its value; on failure it throws a Fault that names the place.

/// Reads a number of a range.
struct NumberIn {
  NumberRange range;
  double operator()(const Place& place) const;
};
std::string read_name(const Place& place);
/// An index or a count.
/// @param what  its name, for the error text.
std::uint32_t read_integer(const Place& place, const char* what, std::uint32_t least = 0,
                           std::uint32_t most = kNone - 1);
const Json& read_array(const Place& place, const char* what);
/// Reads all numbers of an array, which must have that length.
void read_numbers(const Place& place, std::span<double> numbers, double largest = kLargest);

}  // namespace sunder::operation_log
