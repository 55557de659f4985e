#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Recomputes the rest terms of particles whose members got other weights, as by a refit. Calls
/// that tear do not change the weights of existing vertices.
void follow_changed_weights(StructureEdit& edit, std::span<const ChangeRecord> changes);

}  // namespace sunder::particles
