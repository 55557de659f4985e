#pragma once

#include <sunder/particles/particle_set.h>

#include "particles/clusters/set_data.h"

namespace sunder::particles {

/// Gives the parts of a body the data behind the set that they follow.
struct StructureOf {
  [[nodiscard]] static const Structure& in(const ParticleSet& set) { return set.data_->now(); }
  [[nodiscard]] static SetData& data(ParticleSet& set) { return *set.data_; }
  [[nodiscard]] static ParticleSet set_of(std::unique_ptr<SetData> data) {
    return ParticleSet(std::move(data));
  }
};

}  // namespace sunder::particles
