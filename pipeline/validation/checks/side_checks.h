#pragma once

#include "pipeline/validation/checks/finding_list.h"
#include "pipeline/validation/checks/pose_batches.h"
#include "pipeline/validation/checks/weight_rows.h"

namespace sunder::validation {

/// Weights on the wrong side: of the mirror plane of a rig whose bones are named left and right,
/// and of a tear.
void check_sides(const RowReader& reader, FindingList& findings);

/// The plane between the left and right bones of a rig.
struct MirrorPlane {
  Vec3d normal = Vec3d::Zero();  ///< To the left. Zero: the rig has no pairs, or is not symmetric.
  Vec3d point = Vec3d::Zero();
  std::vector<int> side_of_bone;     ///< -1 left, +1 right, 0 neither.
  std::vector<Index> mirrored_bone;  ///< Its own number where a bone has no pair.
};
[[nodiscard]] MirrorPlane find_mirror_plane(const Skinned& skin);

}  // namespace sunder::validation
