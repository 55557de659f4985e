#pragma once

#include "pipeline/validation/checks/finding_list.h"
#include "pipeline/validation/checks/pose_batches.h"
#include "pipeline/validation/checks/skin_points.h"

namespace sunder::validation {

/// How edges, faces and blended matrices of the target do in random poses where its weights differ
/// from those of its match. Each is compared with what the matched weights would do at the same
/// vertices, so that what the source does too is no finding.
void check_shapes(const RowReader& reader, const SkinPoints& points,
                  const SkinDifferences& differences, const PoseBatch& random,
                  FindingList& findings);

}  // namespace sunder::validation
