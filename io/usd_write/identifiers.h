#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace sunder::usd {

/// Names of the prims of one parent, or of the joints of a skeleton: letters, digits and
/// underscores of ASCII, which every version of USD takes, and each once.
class Identifiers {
 public:
  /// An identifier like `name` that none before it is: other characters become underscores, a digit
  /// at the beginning gets one before it, a name that is there already gets "_2", "_3" ….
  /// @param kind  is used where the name is empty.
  std::string add(std::string_view name, std::string_view kind);

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::uint32_t> next_number_;  ///< To append, per identifier that was asked.
};

/// The metadata of a prim that keep a name that is no identifier: `displayName = "…"`; none for
/// others.
[[nodiscard]] std::vector<std::string> display_name(std::string_view name,
                                                    std::string_view identifier);

}  // namespace sunder::usd
