#pragma once

#include <string>

#include "io/urdf/findings.h"
#include "io/urdf/tags.h"

namespace sunder::urdf {

/// Reads the tags of a text that check_text() accepts. What is wrong, missing or ignored becomes a
/// finding; the result is used only if none of them is an error.
[[nodiscard]] RobotTags read_tags(const std::string& text, Findings& findings);

}  // namespace sunder::urdf
