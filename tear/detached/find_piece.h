#pragma once

#include <sunder/operation/operation.h>

#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// A face of the piece at a place, in the pose in which the surface stands.
/// @return index_out_of_range for a triangle that does not exist; not_found for one that is
///         retired or degenerate, for an unknown bone, and where no face counts; non_finite_value.
[[nodiscard]] Result<Index> find_piece(const PiecePlace& place, const Workpiece& work);

}  // namespace sunder::tear
