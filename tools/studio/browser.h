#pragma once

#include <string>

namespace sunder::tools {

/// Lets the desktop open an address in the user's browser. @return whether a program does it.
[[nodiscard]] bool open_in_browser(const std::string& address);

}  // namespace sunder::tools
