#pragma once

#include <sunder/particles/particle_set.h>

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Gives the parts of a body the data behind the set that they follow.
struct StructureOf {
  [[nodiscard]] static const Structure& in(const ParticleSet& set) { return *set.structure_; }
};

}  // namespace sunder::particles
