#pragma once

#include "pipeline/validation/checks/finding_list.h"
#include "pipeline/validation/checks/weight_rows.h"

namespace sunder::validation {

/// How the weights of single bones lie on the surface: outliers among neighbours, islands, and
/// weight far from where a bone governs.
void check_supports(const RowReader& reader, FindingList& findings);

[[nodiscard]] Places find_outliers(const Skinned& skin);
[[nodiscard]] Places find_islands(const Skinned& skin);
/// A bone governs the points where no other bone has more weight. Weighted points farther than a
/// tenth of the diagonal from there, along the surface, are not near; on parts of the surface where
/// it governs nothing, the straight distance counts. A place's value is the share of such points
/// among the bone's weighted points.
[[nodiscard]] Places find_bleeding(const Skinned& skin);

}  // namespace sunder::validation
