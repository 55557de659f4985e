#pragma once

#include "pipeline/validation/checks/pose_batches.h"
#include "pipeline/validation/checks/skin_points.h"

namespace sunder::validation {

/// Figures of published measures over the first 10 random poses.
[[nodiscard]] PaperFigures measure_for_papers(const RowReader& reader, const SkinPoints& points,
                                              const SkinDifferences& differences,
                                              const PoseBatch& random);

}  // namespace sunder::validation
