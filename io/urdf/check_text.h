#pragma once

#include <string>

#include "io/urdf/findings.h"

namespace sunder::urdf {

/// Limits for the text of a URDF file, before any XML parser sees it. A robot of 20,000 joints has
/// 16 tags and attributes per joint.
inline constexpr std::size_t kMaximumDepth = 64;
inline constexpr std::size_t kMaximumTags = 500'000;  ///< Tags and attributes.
/// The most attributes of one tag: the parser compares each of them with all earlier ones.
inline constexpr std::size_t kMaximumAttributes = 100;

/// Scans the tags of the text without recursion: their depth and number, and declarations of
/// entities. Bytes that are not UTF-8 are replaced in place. What is wrong becomes a finding.
/// O(length).
void check_text(std::string& text, Findings& findings);

}  // namespace sunder::urdf
