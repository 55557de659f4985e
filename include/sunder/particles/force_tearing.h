#pragma once

#include <sunder/particles/soft_body.h>

#include <vector>

namespace sunder {

struct ForceTearingOptions {
  double length = 0.5;  ///< How far the tissue tears in one call, at most: a part of the particles' range; in (0, 2].
};

struct ForceTearingReport {
  /// Of all neighbours that are awake: their distance over that at rest; of those nearer at rest than seeds are, 1 and how much
  /// farther they are over how near seeds may be.
  double greatest_stretch = 0.0;
  bool has_torn = false;
  bool is_from_tip = false;         ///< A tear ran on; else one began.
  Vec3d place = Vec3d::Zero();      ///< Where it began, on the posed surface; model space.
  Vec3d direction = Vec3d::Zero();  ///< In which it ran; unit length.
  TearReport tear;
};

/// Tears the tissue where it is stretched beyond what its material bears: runs a tear on from its tip, where the pair of neighbours
/// that is stretched most has one near, or begins one between the two; across the direction of the greatest stretch around them, a
/// bounded length a call. To be called after SoftBody::step(). The tear is an operation like any stroke: it stands in the history
/// with its blades and its pose, and is undone and replayed as one. Deterministic.
///
/// @param body       its materials say what they bear (SoftMaterial::strength); the lesser of the two of a pair counts.
/// @param particles  those of the body; they follow the tear.
/// @param model      torn by at most one operation.
/// @param pose       that of the last step.
/// @param changes    appended where given.
/// @return invalid_argument for the options; what the tear was refused for (nothing is changed). O(particles awake x neighbours)
///         where nothing tears; else what a tear and its repair take, and O(points of lips).
SUNDER_API Result<ForceTearingReport> tear_overstretched(const SoftBody& body, ParticleSet& particles, TornModel& model,
                                                         const ModelPose& pose, const ForceTearingOptions& options = {},
                                                         std::vector<ChangeRecord>* changes = nullptr);

}  // namespace sunder
