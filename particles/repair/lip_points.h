#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Puts the points on lips that some calls made. @return points that are new on lips of the
/// operation that is followed.
std::vector<Index> put_points_on_lips(StructureEdit& edit, std::span<const ChangeRecord> changes);

}  // namespace sunder::particles
