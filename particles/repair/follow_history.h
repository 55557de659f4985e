#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Brings a structure to the newest operation of its model: takes operations back, does them again,
/// or follows new ones.
/// @throws std::bad_alloc, half way.
void follow_history(const TornModel& model, Structure& structure,
                    std::span<const ChangeRecord> changes);

}  // namespace sunder::particles
