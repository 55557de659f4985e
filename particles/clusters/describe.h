#pragma once

#include "particles/clusters/band.h"
#include "particles/clusters/structure.h"
#include "particles/clusters/tape.h"

namespace sunder::particles {

// Descriptions of the data of a structure for a Tape.

void describe(Tape& tape, ParticleInfluences& of);
void describe(Tape& tape, LipPoint& of);
void describe(Tape& tape, LipEdge& of);
void describe(Tape& tape, Particle& of);
void describe(Tape& tape, PendingWork& of);
void describe(Tape& tape, Change& of);
void describe(Tape& tape, Band& of);

/// Describes a structure by its differences from the decomposition.
/// @param of  while reading, a copy of it.
void describe(Tape& tape, Structure& of, const Structure& decomposition);

}  // namespace sunder::particles
