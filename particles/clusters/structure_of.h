#pragma once

#include <sunder/particles/particle_set.h>

#include "particles/clusters/set_data.h"

namespace sunder::particles {

/// Gives the parts of a body the data behind the set that they follow.
struct StructureOf {
  [[nodiscard]] static const Structure& in(const ParticleSet& set) { return set.data_->now(); }
};

}  // namespace sunder::particles
