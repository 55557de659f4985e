#pragma once

#include "pipeline/validation/checks/finding_list.h"
#include "pipeline/validation/checks/pose_batches.h"
#include "pipeline/validation/checks/skin_points.h"

namespace sunder::validation {

/// The limits of a platform on influences.
struct ProfileLimits {
  std::string_view name;
  std::size_t influences = 0;
  WeightFormat format = WeightFormat::float32;
};
[[nodiscard]] ProfileLimits limits_of(TargetProfile profile);

/// Prunes and quantises the target's weights as the platform does, and reports how far that moves
/// its vertices.
void check_profile(const RowReader& reader, const SkinPoints& points,
                   std::span<const PoseBatch> batches, TargetProfile profile,
                   FindingList& findings);

}  // namespace sunder::validation
