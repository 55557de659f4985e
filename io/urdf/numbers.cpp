#include "io/urdf/numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

namespace sunder::urdf {
namespace {

constexpr std::string_view kWhiteSpace = " \t\r\n";

std::vector<std::string_view> words_of(std::string_view text, std::size_t most) {
  std::vector<std::string_view> words;
  while (words.size() <= most) {
    const std::size_t begin = text.find_first_not_of(kWhiteSpace);
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    const std::size_t end = std::min(text.find_first_of(kWhiteSpace), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return words;
}

std::string faulty(const char* attribute, std::string_view text, const std::string& why) {
  return std::string(attribute) + "=\"" + std::string(text.substr(0, 60)) + "\" " + why;
}

}  // namespace

bool read_numbers(std::string_view text, const char* attribute, const Place& place,
                  std::span<double> numbers, Findings& findings) {
  const std::vector<std::string_view> words = words_of(text, numbers.size());
  const auto fail = [&](const char* code, const std::string& why) {
    findings.add(code, place, faulty(attribute, text, why));
    return false;
  };
  if (words.size() != numbers.size())
    return fail("number_malformed",
                "has another number of parts than " + std::to_string(numbers.size()));
  std::vector<double> read;
  for (std::string_view word : words) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error == std::errc::result_out_of_range)
      return fail("number_not_finite", "is beyond the range of numbers");
    if (error != std::errc() || end != word.data() + word.size())
      return fail("number_malformed", "is not a number");
    if (!std::isfinite(number)) return fail("number_not_finite", "is not finite");
    read.push_back(number);
  }
  std::copy(read.begin(), read.end(), numbers.begin());
  return true;
}

}  // namespace sunder::urdf
