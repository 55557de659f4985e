#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "io/urdf/findings.h"

namespace tinyxml2 {
class XMLElement;
}

namespace sunder::urdf {

/// Tags that loading ignores: each name becomes one finding, with its first line.
class IgnoredTags {
 public:
  explicit IgnoredTags(Findings& findings) : findings_(findings) {}

  void add(std::string_view parent, const tinyxml2::XMLElement& tag);
  /// Adds the findings.
  void finish();

 private:
  struct Seen {
    std::uint32_t line = 0, count = 0;
  };
  Findings& findings_;
  std::map<std::string, Seen> seen_;  ///< By "<tag> in <parent>".
};

}  // namespace sunder::urdf
