#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Sets all parts of a structure that was read which follow from others: influences, owners and
/// members from memberships, now and before each operation. Memberships must have been checked.
/// @param structure  a copy of the decomposition, into which it was read.
/// O(points + memberships that changed). @throws std::bad_alloc
void derive(Structure& structure, const Structure& decomposition);

}  // namespace sunder::particles
