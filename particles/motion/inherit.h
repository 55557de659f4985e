#pragma once

#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// Gives a new particle the motion of its parents and the material of the greatest of them; nothing
/// acts on it yet. It is awake.
/// @param parents  existing particles; weights all 0: none, and the particle is at rest.
void inherit(const ParticleInfluences& parents, Index particle, RestMotion& rests, Motion& motion);

}  // namespace sunder::particles
