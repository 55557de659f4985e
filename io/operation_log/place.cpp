#include "io/operation_log/place.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/internal/nearest_names.h"
#include "core/operation/internal/field_ranges.h"

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

const char* text_of_largest(double largest) {
  return largest == kLargest              ? "number beyond 1e9"
         : largest == kLargestMatrixEntry ? "number beyond 1e30"
                                          : "number beyond 1e60";
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
  return {value[index], path + "/" + std::to_string(index), operation, model};
}

Place Place::at(const std::string& key) const {
  const auto found = value.find(key);
  if (found == value.end()) malformed("field '" + key + "' is missing");
  return {*found, pointer_to(key), operation, model};
}

std::string Place::pointer_to(const std::string& key) const { return path + "/" + escaped(key); }

void Place::check_fields(std::span<const std::string_view> known,
                         std::initializer_list<std::string_view> more) const {
  if (!value.is_object()) expected("an object");
  for (const auto& [key, unused] : value.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end() ||
        std::find(more.begin(), more.end(), key) != more.end())
      continue;
    std::vector<std::string> names(known.begin(), known.end());
    names.insert(names.end(), more.begin(), more.end());
    const std::vector<std::string> near = nearest_names(key, names);
    malformed("unknown field '" + key + "'" +
              (near.empty() ? "" : "; did you mean " + listed_names(near) + "?"));
  }
}

double NumberIn::operator()(const Place& place) const {
  if (!place.value.is_number()) place.expected("a number");
  const auto number = place.value.get<double>();
  if (range.or_else != nullptr && number == 0) return number;
  if (const Status status = range.check(number); !status)
    place.malformed(std::string(status.text()));
  return number;
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
    if (!is_number_up_to(array[i], largest)) place.at(i).malformed(text_of_largest(largest));
    numbers[i] = array[i].get<double>();
  }
}

}  // namespace sunder::operation_log
