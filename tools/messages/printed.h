#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>

#include <string>

namespace sunder::tools {

/// printf into a string.
[[nodiscard]] SUNDER_PRINTF(1, 2) std::string printed(const char* format, ...);

/// "(0.1, -2, 3.25)", with four digits.
[[nodiscard]] std::string point_text(const Vec3d& point);

}  // namespace sunder::tools
