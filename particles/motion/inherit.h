#pragma once

#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// Makes a new particle move as what it was torn from, and be of what most of that was of; nothing acts on it yet. It is awake.
/// @param parents  other particles, which are there; weights all 0: none, and the particle is at rest.
void inherit(const ParticleInfluences& parents, Index particle, RestMotion& rests, Motion& motion);

}  // namespace sunder::particles
