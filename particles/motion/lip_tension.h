#pragma once

#include <sunder/particles/soft_body.h>

#include "particles/motion/motion.h"

namespace sunder::particles {

/// What the tissue beyond a lip's edge pulled with is missing there: half of the edge's share at each of its ends, distributed to
/// particles by the ends' influences.
/// @param positions, influences  one a point. @param forces  one a particle, added to: newtons, in the decomposition's pose.
void add_lip_forces(std::span<const LipEdge> lips, std::span<const Vec3f> positions, std::span<const ParticleInfluences> influences,
                    const Tension& tension, std::span<Vec3d> forces);

/// Writes Motion::lip_forces. @param changed  particles whose force is another now. O(particles + lip edges).
void pull_lips(const ParticleSet& set, const Tension& tension, Motion& motion, std::vector<Vec3d>& scratch,
               std::vector<Index>& changed);

}  // namespace sunder::particles
