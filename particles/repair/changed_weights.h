#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Computes the rest terms of particles anew whose members got other weights, as by a refit. Calls
/// that tear change no weights of vertices that were there.
void follow_changed_weights(StructureEdit& edit, std::span<const ChangeRecord> changes);

}  // namespace sunder::particles
