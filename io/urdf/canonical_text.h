#pragma once

#include <string>

#include "io/urdf/tags.h"

namespace sunder::urdf {

/// The tags as URDF text without anything that Sunder does not use. Link 3 is named "l3", joint 2
/// "j2"; all numbers keep their bits.
[[nodiscard]] std::string canonical_text(const RobotTags& tags);

}  // namespace sunder::urdf
