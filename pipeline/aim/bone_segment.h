#pragma once

#include "pipeline/aim/bone_tree.h"
#include "pipeline/aim/posed_surface.h"

namespace sunder::aim {

/// A bone as a line in the pose: from its joint to the joint of the bone that it leads to or, at
/// the end of a chain, to the end of what it moves.
struct BoneSegment {
  Vec3d start = Vec3d::Zero(), end = Vec3d::Zero();
  Index next = kNone;  ///< The bone that it leads to; kNone at the end of a chain.

  [[nodiscard]] Vec3d direction() const;  ///< Unit length.
  [[nodiscard]] double length() const;
  [[nodiscard]] Vec3d place(double share) const { return start + share * (end - start); }
};

/// @return not_found if the bone moves nothing; invalid_argument if it has no length.
[[nodiscard]] Result<BoneSegment> bone_segment(const PosedSurface& surface, const BoneTree& tree,
                                               Index bone);

}  // namespace sunder::aim
