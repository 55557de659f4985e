#include "io/operation_log/place.h"

#include <algorithm>
#include <cmath>

namespace sunder::operation_log {
namespace {

/// RFC 6901.
std::string escaped(const std::string& key) {
  std::string result;
  for (const char c : key) result += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return result;
}

bool is_number_up_to(const Json& value, double largest) {
  return value.is_number() &&
         std::abs(value.get<double>()) <= largest;  // False for numbers that are not finite.
}

}  // namespace

void Place::fail(StatusCode code, const std::string& text) const {
  throw Fault{
      Status::failure(code, operation, "%s: %s", path.empty() ? "/" : path.c_str(), text.c_str())};
}

void Place::expected(const char* what) const {
  malformed(std::string("expected ") + what + ", found " + value.type_name() +
            (value.is_array() ? " of " + std::to_string(value.size()) : ""));
}

Place Place::at(std::size_t index) const {
  return {value[index], path + "/" + std::to_string(index), operation};
}

Place Place::at(const std::string& key) const {
  const auto found = value.find(key);
  if (found == value.end()) malformed("field '" + key + "' is missing");
  return {*found, pointer_to(key), operation};
}

std::string Place::pointer_to(const std::string& key) const { return path + "/" + escaped(key); }

void Place::check_fields(std::initializer_list<std::string_view> known) const {
  if (!value.is_object()) expected("an object");
  for (const auto& [key, unused] : value.items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      malformed("unknown field '" + key + "'");
}

double read_number(const Place& place) {
  if (!place.value.is_number()) place.expected("a number");
  if (!is_number_up_to(place.value, kLargest)) place.malformed("number beyond 1e9");
  return place.value.get<double>();
}

double read_number_at_least_zero(const Place& place) {
  const double number = read_number(place);
  if (number < 0.0) place.malformed("negative");
  return number;
}

double read_number_above_zero(const Place& place) {
  const double number = read_number(place);
  if (!(number > 0.0)) place.malformed("not above 0");
  return number;
}

bool read_bool(const Place& place) {
  if (!place.value.is_boolean()) place.expected("true or false");
  return place.value.get<bool>();
}

std::string read_name(const Place& place) {
  if (!place.value.is_string()) place.expected("a string");
  return place.value.get<std::string>();
}

std::uint32_t read_integer(const Place& place, const char* what, std::uint32_t least,
                           std::uint32_t most) {
  if (!place.value.is_number_unsigned())
    place.expected((std::string(what) + ", an integer from " + std::to_string(least)).c_str());
  const auto integer = place.value.get<std::uint64_t>();
  if (integer < least) place.malformed("expected at least " + std::to_string(least));
  if (integer > most) place.malformed("expected at most " + std::to_string(most));
  return static_cast<std::uint32_t>(integer);
}

std::uint32_t read_material(const Place& place) {
  return read_integer(place, "the index of a material");
}

const Json& read_array(const Place& place, const char* what) {
  if (!place.value.is_array()) place.expected(what);
  return place.value;
}

void read_numbers(const Place& place, std::span<double> numbers, double largest) {
  const Json& array = place.value;
  if (!array.is_array() || array.size() != numbers.size())
    place.expected(("an array of " + std::to_string(numbers.size()) + " numbers").c_str());
  // Logs of strokes contain millions of matrix entries, so the place of a single number is only
  // built for an error.
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!array[i].is_number()) place.at(i).expected("a number");
    if (!is_number_up_to(array[i], largest))
      place.at(i).malformed(largest == kLargest ? "number beyond 1e9" : "number beyond 1e30");
    numbers[i] = array[i].get<double>();
  }
}

Vec3d read_direction(const Place& place, const char* what) {
  const Vec3d direction = read_vector<3>(place);
  if (direction == Vec3d::Zero()) place.malformed(std::string(what) + " of zero length");
  return direction;
}

}  // namespace sunder::operation_log
