#pragma once

#include <sunder/particles/soft_body.h>

#include "particles/motion/motion.h"

namespace sunder::particles {

/// What pulls at lips.
struct LipTension {
  const Tension& tension;
  /// Per particle, as PoseTension::added(): adds to the tension, but lips are never pushed. Empty:
  /// nothing is added.
  std::span<const Mat3d> added = {};
  std::span<const PointFactors> factors = {};  ///< Per point, of the tension; empty: all 1.
};

/// The tension's pull at a lip edge: times its length if LipEdge::inward is so long; in the
/// decomposition's pose.
/// @param owner  the particle in whose cell it pulls.
[[nodiscard]] Vec3d pull_at(const LipEdge& lip, std::span<const Vec3f> positions,
                            const LipTension& tension, Index owner);

/// Adds the force of the tension at lips, where the tissue across the edge no longer balances it:
/// half of an edge's force on the cell of each of its ends.
/// @param positions, owners  per point.
/// @param forces  per particle, added to: newtons, in the decomposition's pose.
void add_lip_forces(std::span<const LipEdge> lips, std::span<const Vec3f> positions,
                    std::span<const Index> owners, const LipTension& tension,
                    std::span<Vec3d> forces);

/// Writes Motion::lip_forces. O(particles + lip edges).
/// @param added  as in LipTension.
/// @param changed  written: particles whose force changed.
void pull_lips(const ParticleSet& set, const Tension& tension, std::span<const Mat3d> added,
               Motion& motion, std::vector<Vec3d>& scratch, std::vector<Index>& changed);

}  // namespace sunder::particles
