#pragma once

#include <sstream>
#include <string>

namespace sunder::test {

/// The concatenation of its arguments.
template <class... Parts>
std::string say(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

}  // namespace sunder::test
