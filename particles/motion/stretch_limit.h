#pragma once

#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// The particles whose springs may reach their limits.
struct StretchWorld {
  const SpringGraph& graph;
  const RestMotion& rests;
  std::span<const Index> active;  ///< Particles that move, ascending.
};

/// Brings neighbours no farther apart than their limits allow, and stops them from parting further:
/// by their masses, pair after pair, until all are within kStretchExcess or nothing more helps.
/// Sleeping particles stay; those that are pulled are woken. Nothing is written where no limit is
/// reached. Position based, after Müller, Heidelberger, Hennix, Ratcliff 2007
/// [mueller2007position].
/// @param pulled  scratch. O(springs of active particles x sweeps).
void limit_stretch(const StretchWorld& world, Motion& motion, std::vector<Index>& pulled);

}  // namespace sunder::particles
