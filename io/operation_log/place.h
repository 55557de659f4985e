#pragma once

#include <sunder/core/math.h>
#include <sunder/core/status.h>

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace sunder::operation_log {

using Json = nlohmann::ordered_json;  // Bones keep the order in which the log names them.

constexpr double kLargest = 1e9;  ///< Largest number: metres, seconds, scale.
constexpr double kLargestMatrixEntry =
    1e30;  ///< Largest entry of a bone matrix, which may hold any scale.

/// Carries a fault out of the nested readers; never leaves io/operation_log.
struct Fault {
  Status status;
};

/// A value and the JSON pointer to it.
struct Place {
  const Json& value;
  std::string path;
  std::uint32_t operation = kNone;

  [[noreturn]] void fail(StatusCode code, const std::string& text) const;
  [[noreturn]] void malformed(const std::string& text) const {
    fail(StatusCode::malformed_file, text);
  }
  [[noreturn]] void expected(const char* what) const;

  [[nodiscard]] Place at(std::size_t index) const;
  [[nodiscard]] Place at(const std::string& key) const;
  [[nodiscard]] bool has(const char* key) const { return value.contains(key); }

  void check_fields(std::initializer_list<std::string_view> known) const;
};

// Each checks its value and otherwise throws a Fault that names the place.

double read_number(const Place& place);
double read_number_at_least_zero(const Place& place);
double read_number_above_zero(const Place& place);
bool read_bool(const Place& place);
std::string read_name(const Place& place);
/// An index from 0, or how many of something.
/// @param what  names it where it is refused.
std::uint32_t read_integer(const Place& place, const char* what, std::uint32_t least = 0,
                           std::uint32_t most = kNone - 1);
const Json& read_array(const Place& place, const char* what);

/// All numbers of an array of that length.
void read_numbers(const Place& place, std::span<double> numbers, double largest = kLargest);

template <int N>
Eigen::Matrix<double, N, 1, Eigen::DontAlign> read_vector(const Place& place) {
  Eigen::Matrix<double, N, 1, Eigen::DontAlign> vector;
  read_numbers(place, {vector.data(), N});
  return vector;
}

/// @param what  names it where it is refused.
Vec3d read_direction(const Place& place, const char* what);

/// @param value  keeps what it is where the field is not given.
template <class Read, class Value>
void read_if_given(const Place& place, const char* key, Read read, Value& value) {
  if (place.has(key)) value = read(place.at(key));
}

}  // namespace sunder::operation_log
