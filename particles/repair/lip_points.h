#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Assigns points that some calls created to lips. @return new points on lips of the current
/// operation.
std::vector<Index> put_points_on_lips(StructureEdit& edit, std::span<const ChangeRecord> changes);

}  // namespace sunder::particles
