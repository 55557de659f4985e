#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Changes the rest terms of particles whose members got other weights, as by a refit. Calls that
/// tear do not change the weights of existing vertices. O(changed vertices x their particles), for
/// changes of several operations, and of vertices of the policy `exact`, O(members of these
/// particles).
void follow_changed_weights(StructureEdit& edit, std::span<const ChangeRecord> changes);

}  // namespace sunder::particles
