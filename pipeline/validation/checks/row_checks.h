#pragma once

#include <span>

#include "pipeline/validation/checks/finding_list.h"
#include "pipeline/validation/checks/weight_rows.h"

namespace sunder::validation {

/// Mistakes of tools that show in single rows: how a new vertex was weighed, which influences were
/// kept, how integers were rounded.
/// @param sum_faults  places with wrong integer sums; those that rounding one by one explains, mesh
///                    by mesh, become SUNDER_W_ROUNDING.
void check_rows(const RowReader& reader, std::span<const DifferentRow> rows, FindingList& findings);
[[nodiscard]] Places take_rounded_one_by_one(const RowReader& reader, Places& sum_faults);

/// Mistakes that show in all weights of a bone.
void check_bones(const RowReader& reader, std::span<const DifferentRow> rows,
                 FindingList& findings);

}  // namespace sunder::validation
