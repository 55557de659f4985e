#pragma once

#include <sunder/core/status.h>

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Checks that the particles of a structure agree with its points, and with one another, now and
/// before each operation: the counts of their members, and neighbours, which are mutual; and that
/// before the first operation it was the decomposition. Undoes the operations for that, without
/// changing the structure. All indices must have been checked. O(points + particles + logged
/// changes). @throws std::bad_alloc
[[nodiscard]] Status check_history(const Structure& structure, const Structure& decomposition);

}  // namespace sunder::particles
