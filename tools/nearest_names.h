#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sunder::tools {

/// Ends the message that `name` is unknown: "; did you mean 'Walk' or 'Run'?" with up to three of
/// the names that resemble it most, or "; there are none" if the list is empty. If none resembles
/// it, the first names of the list are given.
[[nodiscard]] std::string offer_names(std::string_view name, std::span<const std::string> names);

}  // namespace sunder::tools
