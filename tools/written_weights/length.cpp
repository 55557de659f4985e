#include "tools/written_weights/length.h"

#include <charconv>
#include <cmath>
#include <utility>

namespace sunder::tools {
namespace {

constexpr std::pair<std::string_view, double> kLengthUnits[] = {
    {"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}};

}  // namespace

std::optional<double> parse_length(std::string_view text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || !std::isfinite(number) || std::signbit(number)) return {};
  std::string_view unit(rest, static_cast<std::size_t>(end - rest));
  if (unit.starts_with(' ')) unit.remove_prefix(1);
  for (const auto& [name, metres] : kLengthUnits)
    if (unit == name) return number * metres;
  return {};
}

}  // namespace sunder::tools
