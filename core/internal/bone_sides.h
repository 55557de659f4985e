#pragma once

#include <sunder/core/api.h>
#include <sunder/core/index.h>
#include <sunder/core/skeleton.h>

#include <string>
#include <vector>

namespace sunder {

/// A key per bone in which names agree that differ in case, separators, prefix or in how they say
/// left and right.
[[nodiscard]] SUNDER_API std::vector<std::string> fuzzy_names(const Skeleton& skeleton);

/// The side that a name tells: -1 left, +1 right, 0 neither. "Arm.L", "arm_l", "LeftArm", "lArm".
[[nodiscard]] SUNDER_API int side_of_name(const std::string& name);

/// Per bone: the bone whose name differs in its side alone; kNone: there is none, or it is
/// ambiguous.
[[nodiscard]] SUNDER_API std::vector<Index> mirrored_bones(const Skeleton& skeleton);

}  // namespace sunder
