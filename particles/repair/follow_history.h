#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Updates a structure to the newest operation of its model: undoes operations, redoes them, or
/// follows new ones.
/// @throws std::bad_alloc, in the middle of an update.
void follow_history(const TornModel& model, Structure& structure,
                    std::span<const ChangeRecord> changes);

}  // namespace sunder::particles
