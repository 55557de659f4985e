#pragma once

#include "particles/clusters/band.h"
#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// A point beside a lip: the place on the chain that is nearest to it, and how far away that is,
/// metres.
struct BandPoint {
  Index point = 0;
  LipChain::Place place;
  float distance = 0;
};

/// Gives a lip particles of its own where those that are left to it are too far away, or too large
/// to let it open.
void make_lip_particles(StructureEdit& edit, LipChain& chain);

/// Lets a point join the particles of its lip that reach it.
void join_lip_particles(StructureEdit& edit, const LipChain& chain, const BandPoint& at);

/// Takes a point out of the particles of the other lip, as far as the way around the tip is longer
/// than the way through the tear was; on the lip itself in any case.
void keep_to_own_side(StructureEdit& edit, const LipChain& chain, const BandPoint& at);

}  // namespace sunder::particles
