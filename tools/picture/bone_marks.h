#pragma once

#include <cstddef>
#include <vector>

#include "tools/model/bone_extents.h"
#include "tools/picture/labels.h"
#include "tools/picture/marks.h"

namespace sunder::tools {

/// Draws the bones that lead to surface as spindles from joint to joint, on top of the model.
void draw_bones(const Skeleton& skeleton, const std::vector<BoneExtent>& extents, Marks& marks);

/// Writes the names of bones with a surface of their own where there is room; those that move most
/// first.
/// @return the number of bones inside the picture that have no name for want of room.
std::size_t name_bones(const Skeleton& skeleton, const std::vector<BoneExtent>& extents,
                       const Viewport& viewport, Labels& labels);

}  // namespace sunder::tools
