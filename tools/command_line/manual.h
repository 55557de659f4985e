#pragma once

#include <string>
#include <vector>

#include "tools/command_line/listed_options.h"

namespace sunder::tools {

/// The manual page sunder(1), in roff with the macros of man(7).
/// @param version  "sunder 0.1.0".
[[nodiscard]] std::string manual_page(const std::vector<ListedVerb>& verbs,
                                      const std::string& version);

}  // namespace sunder::tools
