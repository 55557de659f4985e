#include "tools/command_line/number_option.h"

#include <charconv>
#include <cmath>
#include <string>

#include "tools/messages/printed.h"

namespace sunder::tools {
namespace {

std::string refusal(const std::string& text, const NumberRange& range, const char* what,
                    const char* units) {
  return "'" + text + "' is no " + what + "; expected one " + range.text() + units;
}

/// What from_chars() reads as numbers, but no option takes.
bool is_not_finite(const std::string& text, double& number) {
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && rest == end && !std::isfinite(number);
}

}  // namespace

CLI::Option* takes(CLI::Option* option, const NumberRange& range, Quantity quantity) {
  return option->transform(CLI::Validator(
      [range, quantity](std::string& text) {
        double number = 0;
        const std::optional<double> value = quantity_in(text, quantity);
        if (!value && !is_not_finite(text, number))
          return refusal(text, range, "number", units_of(quantity));
        const Status status = range.check(value.value_or(number));
        if (status && value) text = printed("%.17g", *value);
        return std::string(status.text());
      },
      range.text()));
}

CLI::Option* takes_count(CLI::Option* option, unsigned least, unsigned most) {
  const NumberRange range = {
      .field = "the value", .least = static_cast<double>(least), .most = static_cast<double>(most)};
  return option->check(CLI::Validator(
      [range](const std::string& text) {
        double number = 0;
        const char* const end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data(), end, number);
        if (error != std::errc() || rest != end || number != std::floor(number))
          return refusal(text, range, "whole number", "");
        return std::string(range.check(number).text());
      },
      range.text()));
}

void check_value(const char* option, const NumberRange& range, double value) {
  if (const Status status = range.check(value); !status)
    throw CLI::ValidationError(option, std::string(status.text()));
}

}  // namespace sunder::tools
