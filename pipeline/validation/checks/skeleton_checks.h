#pragma once

#include "pipeline/validation/checks/finding_list.h"
#include "pipeline/validation/checks/weight_rows.h"

namespace sunder::validation {

/// The factor by which the target is larger than the source, if meshes and skeletons agree on one
/// other than 1; else 1.
[[nodiscard]] double find_scale(const Skinned& source, const Skinned& target,
                                const BoneMatch& bones);

/// The character with all its lengths divided.
[[nodiscard]] Character divided_by(const Character& character, double scale);

/// Bind matrices, default pose and clips beside those of the source.
void check_skeletons(const RowReader& reader, FindingList& findings);

}  // namespace sunder::validation
