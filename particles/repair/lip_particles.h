#pragma once

#include "particles/clusters/band.h"
#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// A point next to a lip: the nearest place on the chain, and its distance, metres.
struct BandPoint {
  Index point = 0;
  LipChain::Place place;
  float distance = 0;
};

/// Gives a lip particles of its own: small ones next to a tip, where the gap becomes narrow within
/// a short distance, and large ones where the remaining ones are too far away.
void make_lip_particles(StructureEdit& edit, LipChain& chain);

/// Adds a point to the particles of its lip that reach it, and at a tip also to those of the other
/// lip.
void join_lip_particles(StructureEdit& edit, std::span<const LipChain> chains,
                        const LipChain& chain, const BandPoint& at);

/// Removes a point from the particles of the other lip, as far as the path around the tip is longer
/// than the former path across the tear; on the lip itself always.
void keep_to_own_side(StructureEdit& edit, const LipChain& chain, const BandPoint& at);

/// Whether a particle is one of the small ones of a tear's lips.
[[nodiscard]] bool is_small_of_lip(const Structure& structure, Index particle, Index tear,
                                   const LipChain& chain);

}  // namespace sunder::particles
