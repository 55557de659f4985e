#include "io/urdf/ignored_tags.h"

#include <algorithm>
#include <tinyxml2.h>

namespace sunder::urdf {
namespace {

/// A file of nothing but unknown tags should not be answered by a list of as many findings.
constexpr std::size_t kMostNames = 64;

}  // namespace

void IgnoredTags::add(std::string_view parent, const tinyxml2::XMLElement& tag) {
  const std::string_view name(tag.Name());
  if (name.starts_with("xacro:")) return;  // reported as such
  const std::string key =
      "<" + std::string(name.substr(0, 60)) + "> in <" + std::string(parent) + ">";
  if (!seen_.contains(key) && seen_.size() >= kMostNames) return;
  Seen& seen = seen_[key];
  if (seen.count++ == 0) seen.line = static_cast<std::uint32_t>(std::max(tag.GetLineNum(), 0));
}

void IgnoredTags::finish() {
  for (const auto& [key, seen] : seen_)
    findings_.add(
        "tag_ignored", {"", seen.line},
        key + (seen.count == 1 ? " is ignored"
                               : " is ignored, " + std::to_string(seen.count) + " times"));
}

}  // namespace sunder::urdf
