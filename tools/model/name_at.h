#pragma once

#include <sunder/core/math.h>

#include <optional>
#include <string>
#include <string_view>

namespace sunder::tools {

/// "Walk@0.5" or "LeftArm@0.4": a name, and what follows its last '@'.
struct NameAt {
  std::string name;
  std::optional<std::string> at;  ///< Empty without an '@'.
};
[[nodiscard]] NameAt split_name_at(const std::string& text);

/// The finite number that a whole text is; empty for other texts.
[[nodiscard]] std::optional<double> number_in(std::string_view text);

/// "0/0/1": three finite numbers; empty for other texts.
[[nodiscard]] std::optional<Vec3d> direction_in(std::string_view text);

}  // namespace sunder::tools
