#include "tools/model/name_at.h"

#include <charconv>
#include <cmath>

namespace sunder::tools {

NameAt split_name_at(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) return {text, {}};
  return {text.substr(0, at), text.substr(at + 1)};
}

std::optional<double> number_in(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return {};
  return number;
}

std::optional<Vec3d> direction_in(std::string_view text) {
  Vec3d direction = Vec3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t end = axis < 2 ? text.find('/') : text.size();
    if (end == std::string_view::npos) return {};
    const std::optional<double> number = number_in(text.substr(0, end));
    if (!number) return {};
    direction[axis] = *number;
    text.remove_prefix(axis < 2 ? end + 1 : end);
  }
  return direction;
}

}  // namespace sunder::tools
