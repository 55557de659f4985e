#pragma once

#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// Gives a new particle the motion of its parents and the material of the one with the largest
/// weight. Nothing acts on it yet. It is awake.
/// @param parents  existing particles; if all weights are 0 there are none, and the particle is at
///         rest.
void inherit(const ParticleInfluences& parents, Index particle, RestMotion& rests, Motion& motion);

}  // namespace sunder::particles
