#pragma once

#include <sunder/animation/pull.h>

#include <span>
#include <vector>

namespace sunder::animation {

/// Per bone its limit, or null.
/// @return index_out_of_range; invalid_argument with the limit, or with a bone that has two.
/// @throws std::bad_alloc
[[nodiscard]] SUNDER_API Result<std::vector<const BoneLimit*>> limit_of_bones(
    std::span<const BoneLimit> limits, std::size_t bone_count);

}  // namespace sunder::animation
