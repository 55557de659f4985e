#pragma once

#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// Brings neighbours no farther apart than their limit allows, and stops them from parting further; by their masses, pair after
/// pair, until all are within a ten thousandth or nothing more helps. Particles that sleep stay; those that are pulled at are
/// woken. Nothing is written where no limit is reached. Position based, after Müller, Heidelberger, Hennix, Ratcliff 2007
/// [mueller2007position]. @param active  who moves, ascending. @param pulled  scratch. O(springs of those x sweeps).
void limit_stretch(const SpringGraph& graph, std::span<const SoftMaterial> materials, const RestMotion& rests,
                   std::span<const Index> active, Motion& motion, std::vector<Index>& pulled);

}  // namespace sunder::particles
