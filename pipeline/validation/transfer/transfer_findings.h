#pragma once

#include <sunder/validation/transfer.h>

#include <vector>

#include "pipeline/validation/transfer/target_bones.h"
#include "pipeline/validation/transfer/target_points.h"

namespace sunder::validation {

/// The data from which the findings of a transfer are read.
struct TransferFacts {
  const Character& source;
  const Character& target;
  const TargetBones& bones;
  const BindSurface& surface;  ///< Of the target.
  const TargetPoints& points;
  const Parts& parts;
  const std::vector<bool>& part_has_match;
};

/// Appends the findings to a result whose counts are complete.
void add_findings(const TransferFacts& facts, TransferResult& result);

}  // namespace sunder::validation
