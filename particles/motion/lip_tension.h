#pragma once

#include <sunder/particles/soft_body.h>

#include "particles/motion/motion.h"

namespace sunder::particles {

/// Adds the force of the tension at lips, where the tissue across the edge no longer balances it:
/// half of an edge's force on the cell of each of its ends.
/// @param positions, owners  per point.
/// @param forces  per particle, added to: newtons, in the decomposition's pose.
void add_lip_forces(std::span<const LipEdge> lips, std::span<const Vec3f> positions,
                    std::span<const Index> owners, const Tension& tension, std::span<Vec3d> forces);

/// Writes Motion::lip_forces. @param changed  written: particles whose force changed. O(particles +
/// lip edges).
void pull_lips(const ParticleSet& set, const Tension& tension, Motion& motion,
               std::vector<Vec3d>& scratch, std::vector<Index>& changed);

}  // namespace sunder::particles
