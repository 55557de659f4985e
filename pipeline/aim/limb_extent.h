#pragma once

#include <vector>

#include "pipeline/aim/bone_tree.h"

namespace sunder::aim {

/// The bones of a limb: those that the skeleton hangs on its bone, and others whose surface adjoins
/// hardly any but theirs: the foot of a rig for inverse kinematics, a thumb that hangs on the
/// forearm, the forearm in a flat list of bones. Not those whose surface adjoins the body as well:
/// the neck of a fish is not a part of its back. Of the bone on which all hang, only the
/// skeleton's.
///
/// O(shared surfaces x depth of the tree), times the number of limbs that are found one by one.
///
/// @return one per bone.
[[nodiscard]] std::vector<bool> bones_of_limb(const PosedSurface& surface, const BoneTree& tree,
                                              Index bone);

}  // namespace sunder::aim
